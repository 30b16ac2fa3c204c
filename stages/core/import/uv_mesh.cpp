// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/uv_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <fmt/format.h>

#include "base/errors.h"
#include "import/readers.h"
#include "import/triangulate.h"
#include "mesh/hard_edges.h"
#include "mesh/same_position.h"
#include "mesh/uv_seams.h"

namespace kiln {

namespace {

constexpr char export_with_uvs[] = "export the mesh again, with its texture coordinates, or give --uv new to make them";

void require_uvs(const std::string& name, const SourceMesh& source) {
  if (source.uvs.empty()) throw BadInput(name, "has no texture coordinates", "a mesh with uvs", export_with_uvs);
  for (std::size_t f = 0; f < source.faces.size(); ++f) {
    const SourceMesh::Face& face = source.faces[f];
    const std::string place = face.line > 0 ? name + ":" + std::to_string(face.line) : name;
    const std::string found = face.line > 0 ? "a face" : "face " + std::to_string(f + 1);
    for (const SourceMesh::Corner& corner : source.corners_of(face)) {
      if (corner.uv == SourceMesh::none)
        throw BadInput(place, found + " without texture coordinates", "texture coordinates at every corner",
                       export_with_uvs);
      if (!source.uvs[corner.uv].allFinite())
        throw BadInput(place, found + " with a texture coordinate that is not a finite number", "finite uvs",
                       export_with_uvs);
    }
  }
}

/// Computes missing normals by compute_vertex_normals, as if vertices at one position were one.
void complete_normals(TriangleMesh& mesh, const std::vector<bool>& has_normal) {
  if (std::find(has_normal.begin(), has_normal.end(), false) == has_normal.end()) return;
  TriangleMesh whole = join_at_positions(mesh);
  compute_vertex_normals(whole);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k)
      if (const std::uint32_t v = mesh.triangles[t][k]; !has_normal[v])
        mesh.normals[v] = whole.normals[whole.triangles[t][k]];
}

}  // namespace

TriangleMesh load_uv_mesh(const std::filesystem::path& file, const ImportSettings& settings,
                          std::vector<std::string>* warnings) {
  const std::string name = file.string();
  SourceMesh source = read_source_mesh(file);
  if (warnings != nullptr) warnings->insert(warnings->end(), source.warnings.begin(), source.warnings.end());
  require_uvs(name, source);
  turn_and_scale(source, settings);
  const std::vector<CutTriangle> triangles = triangulate(source);
  const Eigen::AlignedBox3d box = box_of(source, triangles);

  TriangleMesh mesh;
  mesh.frame = frame_of(box.min(), box.max());
  std::vector<bool> has_normal;
  std::vector<float> values;  // of the corners: 8 each
  const bool takes_normals =
      settings.normals.kind == NormalChoice::Kind::automatic || settings.normals.kind == NormalChoice::Kind::file;
  const auto add_corner = [&](const SourceMesh::Corner& corner) {
    const Eigen::Vector3f position = mesh.frame.from_file(source.places[corner.place]).cast<float>();
    const Eigen::Vector2f& uv = source.uvs[corner.uv];
    Eigen::Vector3f normal = Eigen::Vector3f::Zero();
    if (takes_normals && corner.normal != SourceMesh::none) normal = source.normals[corner.normal].normalized();
    if (!normal.allFinite()) normal.setZero();
    for (const float value :
         {position.x(), position.y(), position.z(), uv.x(), uv.y(), normal.x(), normal.y(), normal.z()})
      values.push_back(value);
  };
  for (const CutTriangle& triangle : triangles)
    for (const std::uint32_t corner : triangle.corners) add_corner(source.corners[corner]);

  // Corners that agree in everything become one vertex.
  const std::vector<std::uint32_t> first = first_of_equals(values, 8), number = without_gaps(first);
  for (std::size_t c = 0; c < first.size(); ++c) {
    if (c % 3 == 0) mesh.triangles.push_back({number[c], number[c + 1], number[c + 2]});
    if (first[c] != c) continue;
    const float* value = &values[8 * c];
    mesh.positions.emplace_back(value[0], value[1], value[2]);
    mesh.uvs.emplace_back(value[3], value[4]);
    mesh.normals.emplace_back(value[5], value[6], value[7]);
    has_normal.push_back(!mesh.normals.back().isZero(0));
  }
  complete_normals(mesh, has_normal);
  return mesh;
}

bool has_whole_uvs(const ImportedSurface& surface) {
  return !surface.uvs.empty() && std::none_of(surface.without_uvs.begin(), surface.without_uvs.end(),
                                              [](const auto& missing) { return missing.found; });
}

std::string fault_of_uvs(const ImportedSurface& surface) {
  if (surface.uvs.empty()) return "";
  for (const ImportedSurface::FaceWithoutUvs& missing : surface.without_uvs)
    if (missing.found)
      return fmt::format(
          "has uvs, but not at every corner ({}), so none of them are kept",
          missing.line > 0 ? fmt::format("line {}", missing.line) : fmt::format("face {}", missing.face));
  return "";
}

TriangleMesh split_at_seams(const ImportedMesh& imported) {
  const TriangleMesh split = split_at_hard_edges(imported.mesh);
  if (!has_whole_uvs(imported.surface)) return split;
  UvSplit seams = split_at_uv_seams(split, imported.surface.uvs);
  seams.mesh.uvs = std::move(seams.uvs);
  return std::move(seams.mesh);
}

}  // namespace kiln
