// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Uvs at the corners of each triangle.
using CornerUvs = std::vector<std::array<Eigen::Vector2f, 3>>;

/// Returns per-vertex uvs as they are at the corners of `triangles`.
CornerUvs uvs_at_corners(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector2f>& uvs);

/// Mesh of one uv per vertex.
struct UvSplit {
  TriangleMesh mesh;
  std::vector<Eigen::Vector2f> uvs;  ///< per vertex
};

/// Splits vertices whose corners have different uvs. Triangles keep their order, vertices their attributes; corner
/// normals are not carried over.
UvSplit split_at_uv_seams(const TriangleMesh& mesh, const CornerUvs& uvs);

/// Joins vertices on both sides of an edge where they have the same positions and normals, as those along a seam of uvs
/// alone do. Edges of more than two triangles stay as they are. Triangles keep their order; uvs of both kinds are
/// dropped.
TriangleMesh join_at_uv_seams(const TriangleMesh& mesh);

}  // namespace kiln
