#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "import/import_mesh.h"
#include "import/source_mesh.h"
#include "import/triangulate.h"

namespace kiln {

/// What the corners of a repaired mesh had in its file. A corner at the place of one of the triangle that it comes from
/// has what that one had; others (where a flat triangle was taken out or a hole closed) have what lies at the nearest
/// point of that triangle.
class CornerAttributes {
 public:
  /// Keeps references to all but `origins`, which tells the entry of `triangles` that each of the mesh's comes from.
  CornerAttributes(const SourceMesh& source, const std::vector<CutTriangle>& triangles, const TriangleMesh& mesh,
                   const TriangleOrigins& origins);

  /// Materials and texture coordinates.
  ImportedSurface surface() const;

  bool has_normals() const { return !source_.normals.empty(); }
  /// As the file has them at each corner, interpolated, of any length; NaN where it has none.
  std::vector<std::array<Eigen::Vector3f, 3>> normals() const;

  bool has_smoothing_groups() const;
  std::vector<std::uint32_t> smoothing_groups() const;

 private:
  /// What a corner is made of: weights of the corners of the triangle that it comes from.
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
