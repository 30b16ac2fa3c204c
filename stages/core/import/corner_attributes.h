// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "import/import_mesh.h"
#include "import/source_mesh.h"
#include "import/triangulate.h"

namespace kiln {

/// Attributes that the corners of a repaired mesh had in its file. A corner at the place of a corner of its source
/// triangle has that corner's attributes. Others (where a flat triangle was removed or a hole closed) have those at the
/// nearest point of the source triangle.
class CornerAttributes {
 public:
  /// Keeps references to all arguments except `origins`, which gives the entry of `triangles` that each of the mesh's
  /// comes from.
  CornerAttributes(const SourceMesh& source, const std::vector<CutTriangle>& triangles, const TriangleMesh& mesh,
                   const TriangleOrigins& origins);

  /// Returns materials, parts and texture coordinates.
  ImportedSurface surface() const;

  bool has_normals() const { return !source_.normals.empty(); }
  /// Returns normals as the file has them at each corner, interpolated, of any length; NaN where it has none.
  std::vector<std::array<Eigen::Vector3f, 3>> normals() const;

  /// Returns how far it is from each corner to its place in a mesh of the same faces and corners, in units of the
  /// frame.
  std::vector<std::array<Eigen::Vector3f, 3>> offsets_to(const SourceMesh& cage) const;

  bool has_smoothing_groups() const;
  std::vector<std::uint32_t> smoothing_groups() const;

 private:
  /// Weights of the corners of the source triangle in a corner.
  using Weights = std::array<float, 3>;

  const SourceMesh::Face& face_of(std::size_t triangle) const;
  const SourceMesh::Corner& source_corner(std::size_t triangle, std::size_t k) const;
  Weights weights(std::size_t triangle, std::size_t corner) const;

  const SourceMesh& source_;
  const std::vector<CutTriangle>& triangles_;
  const TriangleMesh& mesh_;
  TriangleOrigins origins_;
};

}  // namespace kiln
