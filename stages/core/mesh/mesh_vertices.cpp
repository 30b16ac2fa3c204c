// SPDX-License-Identifier: MIT
#include "mesh/mesh_vertices.h"

#include <utility>

#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

/// Appends what `from` has at each of `vertices` to `to`.
template <class Value>
void take(const std::vector<Value>& from, std::span<const std::uint32_t> vertices, std::vector<Value>& to) {
  if (from.empty()) return;
  to.reserve(vertices.size());
  for (const std::uint32_t vertex : vertices) to.push_back(from[vertex]);
}

}  // namespace

TriangleMesh with_vertices(const TriangleMesh& mesh, std::span<const std::uint32_t> vertices) {
  TriangleMesh taken;
  taken.frame = mesh.frame;
  take(mesh.positions, vertices, taken.positions);
  take(mesh.normals, vertices, taken.normals);
  take(mesh.uvs, vertices, taken.uvs);
  take(mesh.texture_uvs, vertices, taken.texture_uvs);
  take(mesh.colors, vertices, taken.colors);
  return taken;
}

TriangleMesh with_triangles(const TriangleMesh& mesh, std::span<const Triangle> triangles,
                            std::vector<std::uint32_t>* sources) {
  constexpr std::uint32_t unused = ~0u;
  std::vector<std::uint32_t> number(mesh.positions.size(), unused), vertices;
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t vertex : triangle) number[vertex] = 0;
  for (std::uint32_t v = 0; v < number.size(); ++v) {
    if (number[v] == unused) continue;
    number[v] = static_cast<std::uint32_t>(vertices.size());
    vertices.push_back(v);
  }
  TriangleMesh taken = with_vertices(mesh, vertices);
  taken.triangles = renumbered(triangles, number);
  if (sources != nullptr) *sources = std::move(vertices);
  return taken;
}

}  // namespace kiln
