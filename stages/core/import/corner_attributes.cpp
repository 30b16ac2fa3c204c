// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/corner_attributes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "mesh/triangle_point.h"

namespace kiln {

namespace {

constexpr std::array<std::array<float, 3>, 3> corner_weights = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

}  // namespace

CornerAttributes::CornerAttributes(const SourceMesh& source, const std::vector<CutTriangle>& triangles,
                                   const TriangleMesh& mesh, const TriangleOrigins& origins)
    : source_(source), triangles_(triangles), mesh_(mesh), origins_(origins) {}

const SourceMesh::Face& CornerAttributes::face_of(std::size_t triangle) const {
  return source_.faces[triangles_[origins_[triangle]].face];
}

const SourceMesh::Corner& CornerAttributes::source_corner(std::size_t triangle, std::size_t k) const {
  return source_.corners[triangles_[origins_[triangle]].corners[k]];
}

CornerAttributes::Weights CornerAttributes::weights(std::size_t triangle, std::size_t corner) const {
  const Eigen::Vector3f& position = mesh_.positions[mesh_.triangles[triangle][corner]];
  std::array<Eigen::Vector3d, 3> at;
  for (std::size_t i = 0; i < 3; ++i) {
    // Turned triangles have their corners in another order; most others keep it.
    const std::size_t k = (corner + i) % 3;
    const Eigen::Vector3f place = mesh_.frame.from_file(source_.places[source_corner(triangle, k).place]).cast<float>();
    if (place == position) return corner_weights[k];
    at[k] = place.cast<double>();
  }
  const Eigen::Vector2d weight = closest_weights(position.cast<double>(), at[0], at[1], at[2]);
  if (!weight.allFinite()) return corner_weights[0];  // the source triangle has no area
  const auto u = static_cast<float>(weight.x()), v = static_cast<float>(weight.y());
  return {1 - u - v, u, v};
}

ImportedSurface CornerAttributes::surface() const {
  ImportedSurface surface;
  surface.materials = source_.materials;
  surface.materials_fault = source_.materials_fault;
  surface.linear_colors = source_.linear_colors;
  const std::size_t count = mesh_.triangles.size(), plain = source_.materials.size();

  if (std::any_of(source_.faces.begin(), source_.faces.end(), [](const auto& face) { return face.material >= 0; })) {
    surface.material_of.reserve(count);
    for (std::size_t t = 0; t < count; ++t) surface.material_of.push_back(face_of(t).material);
  }

  surface.parts = source_.parts;
  if (!surface.parts.empty()) {
    surface.part_of.reserve(count);
    for (std::size_t t = 0; t < count; ++t) surface.part_of.push_back(face_of(t).part);
  }

  surface.without_uvs.resize(plain + 1);
  for (std::uint32_t f = 0; f < source_.faces.size(); ++f) {
    const SourceMesh::Face& face = source_.faces[f];
    ImportedSurface::FaceWithoutUvs& missing =
        surface.without_uvs[face.material < 0 ? plain : static_cast<std::size_t>(face.material)];
    if (missing.found) continue;
    for (const SourceMesh::Corner& corner : source_.corners_of(face))
      if (corner.uv == SourceMesh::none || !source_.uvs[corner.uv].allFinite()) missing = {true, face.line, f + 1};
  }

  if (source_.uvs.empty()) return surface;
  surface.uvs.resize(count);
  for (std::size_t t = 0; t < count; ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Weights weight = weights(t, c);
      Eigen::Vector2f uv = Eigen::Vector2f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        const std::uint32_t index = source_corner(t, k).uv;
        if (weight[k] != 0 && index != SourceMesh::none && source_.uvs[index].allFinite())
          uv += weight[k] * source_.uvs[index];
      }
      surface.uvs[t][c] = uv;
    }
  return surface;
}

std::vector<std::array<Eigen::Vector3f, 3>> CornerAttributes::normals() const {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  std::vector<std::array<Eigen::Vector3f, 3>> normals(mesh_.triangles.size());
  for (std::size_t t = 0; t < normals.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Weights weight = weights(t, c);
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        if (weight[k] == 0) continue;
        const std::uint32_t index = source_corner(t, k).normal;
        sum += index != SourceMesh::none ? Eigen::Vector3f(weight[k] * source_.normals[index].normalized())
                                         : Eigen::Vector3f(Eigen::Vector3f::Constant(nan));
      }
      normals[t][c] = sum;
    }
  return normals;
}

std::vector<std::array<Eigen::Vector3f, 3>> CornerAttributes::offsets_to(const SourceMesh& cage) const {
  std::vector<std::array<Eigen::Vector3f, 3>> offsets(mesh_.triangles.size());
  for (std::size_t t = 0; t < offsets.size(); ++t)
    for (std::size_t c = 0; c < 3; ++c) {
      const Weights weight = weights(t, c);
      Eigen::Vector3d offset = Eigen::Vector3d::Zero();
      for (std::size_t k = 0; k < 3; ++k) {
        if (weight[k] == 0) continue;
        const CutTriangle& cut = triangles_[origins_[t]];
        const std::uint32_t in_face = cut.corners[k] - source_.faces[cut.face].first_corner;
        const std::uint32_t place = cage.corners[cage.faces[cut.face].first_corner + in_face].place;
        offset += weight[k] * (cage.places[place] - source_.places[source_.corners[cut.corners[k]].place]);
      }
      offsets[t][c] = (offset / mesh_.frame.unit()).cast<float>();
    }
  return offsets;
}

bool CornerAttributes::has_smoothing_groups() const {
  return source_.has_smoothing_groups && std::any_of(source_.faces.begin(), source_.faces.end(),
                                                     [](const auto& face) { return face.smoothing_group != 0; });
}

std::vector<std::uint32_t> CornerAttributes::smoothing_groups() const {
  std::vector<std::uint32_t> groups;
  groups.reserve(mesh_.triangles.size());
  for (std::size_t t = 0; t < mesh_.triangles.size(); ++t) groups.push_back(face_of(t).smoothing_group);
  return groups;
}

}  // namespace kiln
