// SPDX-License-Identifier: MIT
#include "asset/check.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

#include "asset/probe_set.h"
#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "image/image_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

bool is_there(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

bool is_described(const fs::path& folder) {
  return is_there(folder / ranges_name) || is_there(folder / pca_name) || is_there(folder / probes_json_name);
}

/// Checks the files that the description of one folder names, each by itself, so that one fault hides no other.
class FileCheck {
 public:
  FileCheck(const fs::path& folder, const PrtDescription& asset, Faults& faults)
      : folder_(folder), asset_(asset), faults_(faults), remedy_(remedy_for(asset)) {}

  void run() {
    if (!asset_.mesh_file.empty()) asset_.vertices > 0 ? check_vertices() : check_atlas();
    for (const PrtLevel& level : asset_.levels)
      if (!level.mesh_file.empty()) faults_.guard([&] { check_level(level); });
    if (asset_.width == 0 || asset_.height == 0) return;  // without the asset's sizes, pictures cannot be checked
    faults_.guard([&] { read_albedo_picture(folder_, asset_); });
    faults_.guard([&] { read_measured_picture(folder_, asset_); });
    faults_.guard([&] { read_opacity_picture(folder_, asset_); });
    for (const PrtMap& map : asset_.maps)
      if (!map.file.empty()) faults_.guard([&] { read_picture(folder_ / map.file); });
    if (!asset_.normals_file.empty()) check_normals();
    check_planes();
    if (asset_.pca) check_tables(*asset_.pca);
  }

 private:
  void check_origin(const TriangleMesh& mesh) {
    const Eigen::Vector3d &said = asset_.origin, &found = mesh.frame.origin;
    if (said != found)
      faults_.tell(BadInput(asset_.ranges_file.string(),
                            fmt::format("origin is {}, {}, {}", said.x(), said.y(), said.z()),
                            fmt::format("{}, {}, {}, as the mesh has it", found.x(), found.y(), found.z()), remedy_));
  }

  void check_atlas() {
    faults_.guard([&] {
      const TriangleMesh mesh = read_atlas_mesh(folder_, asset_);
      check_origin(mesh);
      const int finest = asset_.levels.empty() ? 0 : asset_.levels.front().triangles;
      if (static_cast<std::size_t>(finest) >= mesh.triangles.size())
        throw BadInput(asset_.ranges_file.string(), fmt::format("levels[0].triangles is {}", finest),
                       fmt::format("fewer than {}, those of the mesh", mesh.triangles.size()), remedy_);
    });
  }

  void check_level(const PrtLevel& level) {
    const TriangleMesh mesh = read_level_mesh(folder_, asset_, level);
    const Eigen::Vector3d &said = asset_.origin, &found = mesh.frame.origin;
    if (said != found)
      throw BadInput((folder_ / level.mesh_file).string(),
                     fmt::format("has the origin {}, {}, {}", found.x(), found.y(), found.z()),
                     fmt::format("{}, {}, {}, as the folder's JSON has it", said.x(), said.y(), said.z()), remedy_);
  }

  void check_vertices() {
    faults_.guard([&] {
      const AttributedMesh mesh = read_vertex_mesh(folder_, asset_);
      check_origin(mesh.mesh);
      for (std::size_t k = 0; k < asset_.planes.size(); ++k) faults_.guard([&] { check_attribute(mesh, k); });
    });
  }

  void check_attribute(const AttributedMesh& mesh, std::size_t k) {
    const IntegerAttribute& attribute = attribute_of(mesh, folder_, asset_, k);
    const std::uint32_t said = asset_.planes[k].unique_id;
    if (said != attribute.unique_id)
      throw BadInput(asset_.ranges_file.string(), fmt::format("planes[{}].unique_id is {}", k, said),
                     fmt::format("{}, as the mesh has it", attribute.unique_id), remedy_);
  }

  void check_normals() {
    const fs::path file = folder_ / asset_.normals_file;
    const bool has_own_size = asset_.normal_width > 0;
    faults_.guard([&] {
      require_picture(read_png_as16(file), file, has_own_size ? asset_.normal_width : asset_.width,
                      has_own_size ? asset_.normal_height : asset_.height, 3, remedy_);
    });
  }

  void check_planes() {
    std::set<std::string> files;
    for (const PrtPlane& plane : asset_.planes) {
      if (plane.file.empty()) continue;  // this fault has been reported already
      if (!files.insert(plane.file).second)
        faults_.tell(BadInput(asset_.ranges_file.string(), "names " + plane.file + " twice",
                              "a picture of its own for every plane", remedy_));
      faults_.guard([&] {
        if (plane.bits == 8)
          read_grey<std::uint8_t>(folder_ / plane.file, asset_.width, asset_.height, remedy_);
        else
          read_grey<std::uint16_t>(folder_ / plane.file, asset_.width, asset_.height, remedy_);
      });
    }
  }

  /// Checks the tables of a compressed asset, except those whose sizes are unknown.
  void check_tables(const PcaTables& tables) {
    const bool has_vectors = !tables.vectors_file.empty() && !tables.coefficient_scales.empty() &&
                             tables.vector_ranges.size() == asset_.planes.size() + 1;
    if (has_vectors) faults_.guard([&] { read_vectors(folder_, asset_); });
    if (!tables.ids_file.empty()) faults_.guard([&] { read_cluster_ids(folder_, asset_); });
  }

  const fs::path& folder_;
  const PrtDescription& asset_;
  Faults& faults_;
  std::string remedy_;
};

/// Checks that `requires` lists exactly what the folder uses.
void check_requirements(const PrtDescription& asset, const FormatHead& head, Faults& faults) {
  if (head.version < 2) return;
  const std::vector<std::string> used = requirements(asset);
  const auto has = [](const std::vector<std::string>& list, const std::string& name) {
    return std::find(list.begin(), list.end(), name) != list.end();
  };
  const auto tell = [&](const std::string& found, const std::string& expected) {
    faults.tell(BadInput(asset.ranges_file.string(), found, expected, remedy_for(asset)));
  };
  for (const std::string& name : used)
    if (!has(head.required, name)) tell("requires lacks " + name, "all that a reader must know to read it");
  for (const std::string& name : head.required)
    if (!has(used, name)) tell("requires " + name + ", which it does not use", "nothing that a reader need not know");
}

CheckedFolder check_description(const fs::path& file) {
  Faults faults(Faults::Mode::keep_all);
  const fs::path folder = file.parent_path();
  const auto [asset, head] = read_description(file, faults);
  check_requirements(asset, head, faults);
  FileCheck(folder, asset, faults).run();
  return {folder, file.filename() == pca_name ? pca_format : prt_format, head.version, faults.found()};
}

CheckedFolder check_probes(const fs::path& folder) {
  Faults faults(Faults::Mode::keep_all);
  const auto [probes, version] = read_probes(folder, faults);
  return {folder, probes_format, version, faults.found()};
}

/// Checks one folder by the description that it has: ranges.json, pca.json or matrices.json.
CheckedFolder check_one(const fs::path& folder) {
  if (is_there(folder / probes_json_name)) return check_probes(folder);
  CheckedFolder checked = check_description(description_file(folder));
  if (is_there(folder / pca_name) && is_there(folder / ranges_name))
    checked.faults.emplace_back(folder.string(), fmt::format("has both {} and {}", ranges_name, pca_name),
                                "one of them", "remove the one that is of an earlier run");
  return checked;
}

}  // namespace

std::vector<CheckedFolder> check_folder(const fs::path& folder) {
  if (is_described(folder)) return {check_one(folder)};
  std::vector<fs::path> inner;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (is_described(entry.path())) inner.push_back(entry.path());
  std::sort(inner.begin(), inner.end());
  std::vector<CheckedFolder> checked;
  for (const fs::path& one : inner) checked.push_back(check_one(one));
  if (checked.empty())
    checked.push_back(
        {folder,
         "",
         0,
         {BadInput(folder.string(),
                   fs::is_directory(folder, error) ? fmt::format("has no {}, {} or {}, nor a folder with one",
                                                                 ranges_name, pca_name, probes_json_name)
                                                   : "is no folder",
                   "what kiln-bake, kiln-compress or kiln-probes wrote, or an asset's folder",
                   "run kiln build, or name its output folder")}});
  return checked;
}

}  // namespace kiln
