// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/import_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>

#include "base/errors.h"
#include "import/corner_attributes.h"
#include "import/imported_normals.h"
#include "import/readers.h"
#include "import/text_lines.h"
#include "import/triangulate.h"
#include "import/weld.h"

namespace kiln {

namespace {

/// Makes a mesh of the vertices that triangles use, in the order of first use.
TriangleMesh to_mesh(const std::string& name, const SourceMesh& source, const std::vector<CutTriangle>& triangles,
                     const MeshFrame& frame) {
  TriangleMesh mesh;
  mesh.frame = frame;
  mesh.triangles.resize(triangles.size());
  constexpr std::uint32_t unseen = ~0u;
  std::vector<std::uint32_t> new_index(source.places.size(), unseen);
  for (std::size_t t = 0; t < triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t place = source.corners[triangles[t].corners[k]].place;
      if (new_index[place] == unseen) {
        new_index[place] = static_cast<std::uint32_t>(mesh.positions.size());
        mesh.positions.emplace_back(frame.from_file(source.places[place]).cast<float>());
        if (!mesh.positions.back().allFinite())
          throw BadInput(name, "vertex " + std::to_string(place + 1) + " lies too far from the asset",
                         "coordinates within 1e38 times the asset's size", "move the mesh, or leave it out");
        if (!source.colors.empty()) mesh.colors.push_back(source.colors[place]);
      }
      mesh.triangles[t][k] = new_index[place];
    }
  return mesh;
}

/// Warns where the file's numbers are too coarse for the shape that they describe.
void warn_of_precision(const SourceMesh& source, const Eigen::AlignedBox3d& box, std::vector<std::string>& warnings) {
  const double size = box.diagonal().norm();
  const double largest = std::max(box.min().cwiseAbs().maxCoeff(), box.max().cwiseAbs().maxCoeff());
  const double step = std::max(source.precision, std::ldexp(largest, -52));
  if (!(step > 5e-4 * size)) return;
  char text[200];
  std::snprintf(text, sizeof text,
                "coordinates of up to %.3g are written in steps of %.2g, and the mesh is %.3g across: its shape is "
                "coarse; export it nearer to the origin or with more digits",
                largest, step, size);
  warnings.emplace_back(text);
}

/// Refuses meshes whose coordinates the files of an asset, which have 32-bit floats, cannot hold: beyond 1e37 some
/// overflow, below 1e-32 steps of 24 bits are no longer exact.
void check_size(const std::string& name, const Eigen::AlignedBox3d& box) {
  constexpr double smallest = 1e-32, largest = 1e37;
  const double side = box.sizes().maxCoeff();
  if (!(side > 0) || (side >= smallest && side <= largest)) return;  // a point has a message of its own
  char found[100];
  std::snprintf(found, sizeof found, "is %.3g across", side);
  throw BadInput(name, found, "a mesh of 1e-32 to 1e+37 units, which 32-bit floats hold",
                 "export it in another unit, or give --scale");
}

void warn_of_repairs(const MeshRepairs& repairs, std::vector<std::string>& warnings) {
  const auto add = [&](int count, const std::string& what, const std::string& rest) {
    if (count > 0) warnings.push_back(counted(static_cast<std::uint64_t>(count), what) + " " + rest);
  };
  add(repairs.welded_vertices, "border corner",
      "within the last digits of another, joined to it; --weld off keeps them apart");
  add(repairs.dropped_backs, "triangle",
      "with the same corners as another, its back, dropped with its material; "
      "--backs keep keeps both sides");
  add(repairs.inside_out_components, "closed component",
      "inside out, turned outwards; --orientation keep leaves it so, as a room is meant to be");
  add(repairs.unorientable_edges, "edge", "cut, as the surface has one side alone, like a Moebius strip");
}

void warn_of_emission(const SourceMesh& source, std::vector<std::string>& warnings) {
  std::vector<bool> is_used(source.materials.size(), false);
  for (const SourceMesh::Face& face : source.faces)
    if (face.material >= 0) is_used[static_cast<std::size_t>(face.material)] = true;
  std::size_t glowing = 0;
  for (std::size_t m = 0; m < is_used.size(); ++m) {
    const SourceMaterial& material = source.materials[m];
    const bool glows = material.emission ? !material.emission->isZero(0) : material.emission_texture.has_value();
    glowing += is_used[m] && glows;
  }
  if (glowing > 0)
    warnings.push_back(
        std::to_string(glowing) + (glowing == 1 ? " material" : " materials") +
        " with light of their own (emission), which no bake has; kiln-normals --maps emission writes it");
}

/// Clamps colours to 0 .. 1; returns how many lay outside.
int clamp_colors(const std::string& name, std::vector<Eigen::Vector3f>& colors) {
  int clamped = 0;
  for (Eigen::Vector3f& color : colors) {
    if (!color.allFinite())
      throw BadInput(name, "a colour of a vertex that is not a finite number", "red, green and blue of 0 to 1",
                     export_again);
    const Eigen::Vector3f inside = color.cwiseMax(0).cwiseMin(1);
    clamped += inside != color;
    color = inside;
  }
  return clamped;
}

}  // namespace

MeshFrame frame_of(const Eigen::Vector3d& lowest, const Eigen::Vector3d& highest) {
  constexpr double farthest_sides = 8;  // at that distance float32 resolves a millionth of the side
  MeshFrame frame;
  const double side = (highest - lowest).maxCoeff();
  if (!(side > 0) || !std::isfinite(side)) return frame;
  const double farthest = std::max(lowest.cwiseAbs().maxCoeff(), highest.cwiseAbs().maxCoeff());
  if (farthest > farthest_sides * side) {
    // Use round numbers, for legible origins.
    const double step = std::ldexp(1.0, std::ilogb(side));
    for (int k = 0; k < 3; ++k) frame.origin[k] = std::round((lowest[k] + highest[k]) / 2 / step) * step;
  }
  frame.exponent = ordinary_exponent(side);
  return frame;
}

namespace {

/// Calls `also` with the attributes at the end, where it is given.
ImportedMesh import(const std::filesystem::path& file, const ImportSettings& settings,
                    const std::optional<MeshFrame>& frame,
                    const std::function<void(const SourceMesh&, const CornerAttributes&)>& also = {}) {
  // Step 1: read the file, in our axes and units, as triangles.
  const std::string name = file.string();
  SourceMesh source = read_source_mesh(file);
  turn_and_scale(source, settings);
  int polygons = 0;
  const std::vector<CutTriangle> triangles = triangulate(source, &polygons);
  ImportedMesh result;
  result.file = file;
  result.warnings = source.warnings;
  result.further_files = source.further_files;
  const int welded = weld_borders(source, triangles, settings.weld);
  const Eigen::AlignedBox3d box = box_of(source, triangles);
  check_size(name, box);
  warn_of_precision(source, box, result.warnings);

  // Step 2: make one clean mesh.
  result.mesh = to_mesh(name, source, triangles, frame ? *frame : frame_of(box.min(), box.max()));
  TriangleMesh& mesh = result.mesh;
  const auto used_vertices = static_cast<int>(mesh.positions.size());
  const int clamped_colors = clamp_colors(name, mesh.colors);
  TriangleOrigins origins;
  MeshRepairs& repairs = result.repairs;
  repairs = repair_mesh(mesh,
                        {.fill_hole_edges = settings.fill_hole_edges,
                         .keeps_orientation = settings.keeps_orientation,
                         .keeps_backs = settings.keeps_backs},
                        &origins);
  constexpr double least_area = 1e-16;  // relative to the squared diagonal; less is a line drawn with triangles
  const double diagonal = bounding_box(mesh).diagonal();
  if (mesh.triangles.empty() || !(surface_area(mesh) > least_area * diagonal * diagonal))
    throw BadInput(name, "has no triangle with an area", "a mesh of triangles or polygons", export_again);
  repairs.clamped_colors = clamped_colors;
  repairs.triangulated_polygons = polygons;
  repairs.unused_vertices += static_cast<int>(source.places.size()) - used_vertices;
  if (source.is_unwelded) repairs.merged_vertices = 0;  // the format repeats each vertex for every face
  repairs.welded_vertices = welded;
  warn_of_repairs(repairs, result.warnings);

  // Step 3: carry over the corners' attributes.
  const CornerAttributes attributes(source, triangles, mesh, origins);
  result.surface = attributes.surface();
  set_normals(mesh, attributes, settings.normals, name, result.warnings);
  warn_of_emission(source, result.warnings);
  if (also) also(source, attributes);
  return result;
}

/// Refuses a cage whose faces are not those of the low mesh.
void check_cage(const std::filesystem::path& file, const SourceMesh& cage, const std::string& low_name,
                const SourceMesh& low) {
  const char* remedy = "export low mesh and cage of one mesh, in one way, both before or both after triangulation";
  if (cage.faces.size() != low.faces.size())
    throw BadInput(file.string(), "has " + std::to_string(cage.faces.size()) + " faces",
                   "the " + std::to_string(low.faces.size()) + " of " + low_name + ", whose cage it is", remedy);
  for (std::size_t f = 0; f < low.faces.size(); ++f)
    if (cage.faces[f].corner_count != low.faces[f].corner_count)
      throw BadInput(
          file.string(),
          "face " + std::to_string(f + 1) + " has " + std::to_string(cage.faces[f].corner_count) + " corners",
          "the " + std::to_string(low.faces[f].corner_count) + " that it has in " + low_name, remedy);
}

}  // namespace

ImportedMesh import_mesh(const std::filesystem::path& file, const ImportSettings& settings,
                         const std::optional<MeshFrame>& frame) {
  return import(file, settings, frame);
}

CagedMesh import_caged_mesh(const std::filesystem::path& file, const std::filesystem::path& cage,
                            const ImportSettings& settings, const std::optional<MeshFrame>& frame) {
  CagedMesh result;
  result.low = import(file, settings, frame, [&](const SourceMesh& low, const CornerAttributes& attributes) {
    SourceMesh source = read_source_mesh(cage);
    turn_and_scale(source, settings);
    check_cage(cage, source, file.string(), low);
    result.offsets = attributes.offsets_to(source);
    result.files = {cage};
    result.files.insert(result.files.end(), source.further_files.begin(), source.further_files.end());
  });
  return result;
}

TriangleMesh load_mesh(const std::filesystem::path& file, MeshRepairs* repairs, const ImportSettings& settings) {
  ImportedMesh imported = import_mesh(file, settings);
  if (repairs != nullptr) *repairs = imported.repairs;
  return std::move(imported.mesh);
}

}  // namespace kiln
