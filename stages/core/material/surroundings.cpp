// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surroundings.h"

#include <utility>

#include "base/errors.h"
#include "base/numbers.h"
#include "import/import_mesh.h"
#include "material/cut_out.h"

namespace kiln {

namespace {

constexpr double ground_half_size_diagonals = 4;

/// Moves a mesh from its own frame into that of the asset, by way of the scene.
void move_to_asset(TriangleMesh& mesh, const Placement& placement, const Placement& asset, const MeshFrame& frame) {
  for (Eigen::Vector3f& p : mesh.positions)
    p = frame.from_file(asset.to_object(placement.to_scene(mesh.frame.to_file(p.cast<double>())))).cast<float>();
  const Eigen::Matrix3f turn = (asset.rotation.transpose() * placement.rotation).cast<float>();
  for (Eigen::Vector3f& normal : mesh.normals) normal = (turn * normal).normalized();
  for (auto& corners : mesh.corner_normals)
    for (Eigen::Vector3f& normal : corners) normal = (turn * normal).normalized();
  mesh.frame = frame;
}

/// Makes a square that faces +Y, in the scene's space, with its centre as origin.
TriangleMesh ground_square(const Eigen::Vector3d& centre, double half_size) {
  TriangleMesh mesh;
  mesh.frame.origin = centre;
  for (const auto& [x, z] : {std::pair(-1, 1), std::pair(1, 1), std::pair(1, -1), std::pair(-1, -1)})
    mesh.positions.emplace_back((half_size * Eigen::Vector3d(x, 0, z)).cast<float>());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  compute_vertex_normals(mesh);
  return mesh;
}

/// Splits a text at semicolons, except at those escaped by a backslash; a backslash is escaped by another.
std::vector<std::string> parts_of(const std::string& text) {
  std::vector<std::string> parts(1);
  for (std::size_t k = 0; k < text.size(); ++k) {
    const bool escapes = text[k] == '\\' && k + 1 < text.size() && (text[k + 1] == ';' || text[k + 1] == '\\');
    if (escapes)
      parts.back() += text[++k];
    else if (text[k] == ';')
      parts.emplace_back();
    else
      parts.back() += text[k];
  }
  return parts;
}

Placement placement_of(const ScenePlace& place) {
  Placement placement;
  placement.translation = Eigen::Vector3d(place.position.data());
  placement.rotation = turn_about_y(place.azimuth_degrees);
  placement.scale = place.scale;
  return placement;
}

}  // namespace

Neighbour parse_neighbour(const std::string& text) {
  Neighbour neighbour;
  std::string place;
  OptionSet fields;
  fields.text("place", place, "");
  add_import_options(fields, neighbour.import);
  add_material_options(fields, neighbour.material);

  const std::vector<std::string> parts = parts_of(text);
  neighbour.file = parts.front();
  const auto refuse = [&](const std::string& found) {
    throw WrongUsage("neighbour: found " + found + " in '" + text +
                     "'; expected FILE[;place=X,Y,Z[,AZIMUTH[,SCALE]]][;albedo=...][;albedo-texture=...]"
                     "[;reflectance=...][;reflectance-of=...][;albedo-encoding=...][;opacity=...][;opacity-texture=...]"
                     "[;opacity-cutoff=...]"
                     "[;up=...][;unit=.."
                     ".][;scale=...][;normals=...][;fill-holes=...]");
  };
  if (neighbour.file.empty()) refuse("no file");
  for (std::size_t k = 1; k < parts.size(); ++k) {
    const std::string& part = parts[k];
    if (part.empty() && k + 1 == parts.size()) break;
    const std::size_t equals = part.find('=');
    const Option* field = equals == std::string::npos ? nullptr : fields.find(part.substr(0, equals));
    if (field == nullptr) refuse("'" + part + "'");
    field->set(part.substr(equals + 1));
  }
  if (!place.empty()) neighbour.placement = parse_placement("neighbour: place", place);
  return neighbour;
}

std::vector<PlacedMesh> load_surroundings(const Surroundings& surroundings, const BoundingBox& own,
                                          const MaterialSettings& material, bool with_albedo, const MeshFrame& frame) {
  const Placement asset = placement_of(surroundings.place);
  std::vector<PlacedMesh> placed;
  for (const std::string& text : surroundings.neighbours) {
    const Neighbour neighbour = parse_neighbour(text);
    std::error_code error;
    if (!std::filesystem::is_regular_file(neighbour.file, error))
      throw BadInput(neighbour.file.string(), "does not exist", "a mesh for --neighbour", "check the path");
    PlacedMesh& mesh = placed.emplace_back();
    mesh.name = neighbour.file.string();
    ImportedMesh imported = import_mesh(neighbour.file, neighbour.import);
    if (with_albedo) mesh.material = load_albedo(imported, neighbour.material);
    const LoadedOpacity opacity = load_opacity(imported, neighbour.material);
    mesh.warnings = std::move(imported.warnings);
    mesh.warnings.insert(mesh.warnings.end(), opacity.warnings.begin(), opacity.warnings.end());
    mesh.opacity_files = opacity.files;
    mesh.mesh = std::move(imported.mesh);
    mesh.sheets = cut_occluder(mesh.mesh, mesh.material.albedo, opacity.opacity, mesh.name);
    move_to_asset(mesh.mesh, neighbour.placement, asset, frame);
  }
  if (!surroundings.ground) return placed;

  Eigen::Vector3d centre = asset.to_scene(frame.to_file(own.centre().cast<double>()));
  centre.y() = surroundings.ground->height;
  const double half_size = surroundings.ground->half_size.value_or(ground_half_size_diagonals * asset.scale *
                                                                   frame.unit() * static_cast<double>(own.diagonal()));
  PlacedMesh& ground = placed.emplace_back();
  ground.name = "the ground";
  ground.mesh = ground_square(centre, half_size);
  move_to_asset(ground.mesh, {}, asset, frame);
  if (with_albedo) ground.material = load_constant_albedo(material);
  return placed;
}

}  // namespace kiln
