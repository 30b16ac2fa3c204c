// SPDX-License-Identifier: MIT
#include "mesh/uv_seams.h"

#include <span>

#include "mesh/disjoint_sets.h"
#include "mesh/mesh_vertices.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

CornerUvs uvs_at_corners(const std::vector<Triangle>& triangles, const std::vector<Eigen::Vector2f>& uvs) {
  CornerUvs corners;
  corners.reserve(triangles.size());
  for (const Triangle& t : triangles) corners.push_back({uvs[t[0]], uvs[t[1]], uvs[t[2]]});
  return corners;
}

UvSplit split_at_uv_seams(const TriangleMesh& mesh, const CornerUvs& uvs) {
  std::vector<float> values;  // at the corners: the vertex in two halves, which floats hold exactly, and the uv
  values.reserve(12 * mesh.triangles.size());
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::size_t k = 0; k < 3; ++k) {
      const std::uint32_t vertex = mesh.triangles[t][k];
      values.insert(values.end(), {static_cast<float>(vertex & 0xffff), static_cast<float>(vertex >> 16), uvs[t][k].x(),
                                   uvs[t][k].y()});
    }
  const std::vector<std::uint32_t> first = first_of_equals(values, 4), number = without_gaps(first);
  UvSplit split;
  std::vector<std::uint32_t> sources;
  std::vector<Triangle> triangles(mesh.triangles.size());
  for (std::size_t c = 0; c < first.size(); ++c) {
    triangles[c / 3][c % 3] = number[c];
    if (first[c] != c) continue;
    sources.push_back(mesh.triangles[c / 3][c % 3]);
    split.uvs.push_back(uvs[c / 3][c % 3]);
  }
  split.mesh = with_vertices(mesh, sources);
  split.mesh.triangles = std::move(triangles);
  return split;
}

TriangleMesh join_at_uv_seams(const TriangleMesh& mesh) {
  const std::vector<Triangle> places = renumbered(mesh.triangles, first_at_position(mesh.positions));
  DisjointSets sets(mesh.positions.size());
  const auto join_where_equal = [&](std::uint32_t corner, std::uint32_t other) {
    const std::uint32_t a = vertex_at(mesh.triangles, corner), b = vertex_at(mesh.triangles, other);
    if (mesh.normals.empty() || mesh.normals[a] == mesh.normals[b]) sets.join(a, b);
  };
  TriangleEdges(places).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() != 2 || !run_opposite(places, sides[0], sides[1])) return;
    join_where_equal(sides[0], next_corner(sides[1]));
    join_where_equal(next_corner(sides[0]), sides[1]);
  });
  const std::vector<std::uint32_t> roots = sets.roots();
  std::vector<std::uint32_t> sources;
  for (std::uint32_t v = 0; v < roots.size(); ++v)
    if (roots[v] == v) sources.push_back(v);
  TriangleMesh joined = with_vertices(mesh, sources);
  joined.triangles = renumbered(mesh.triangles, without_gaps(roots));
  joined.uvs.clear();
  joined.texture_uvs.clear();
  return joined;
}

}  // namespace kiln
