// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <numeric>
#include <utility>

#include "simplify/collapse.h"

namespace kiln {

int CollapseSequence::faces_after(std::size_t count) const {
  return count == 0 ? static_cast<int>(start.triangles.size()) : collapses[count - 1].faces;
}

std::size_t CollapseSequence::count_for(int faces) const {
  if (faces_after(0) <= faces) return 0;
  const auto found =
      std::partition_point(collapses.begin(), collapses.end(), [&](const Collapse& c) { return c.faces > faces; });
  return found == collapses.end() ? collapses.size() : static_cast<std::size_t>(found - collapses.begin()) + 1;
}

namespace {

/// Finds which vertex each of the start's vertices is after the first `count` collapses.
std::vector<std::uint32_t> vertices_after(const CollapseSequence& sequence, std::size_t count) {
  std::vector<std::uint32_t> became(sequence.start.positions.size());
  std::iota(became.begin(), became.end(), 0u);
  for (std::size_t i = 0; i < count; ++i) became[sequence.collapses[i].removed] = sequence.collapses[i].kept;
  // Follow each vertex to the last that it became.
  for (std::uint32_t vertex = 0; vertex < became.size(); ++vertex) {
    std::uint32_t last = vertex;
    while (became[last] != last) last = became[last];
    for (std::uint32_t at = vertex; became[at] != last;) at = std::exchange(became[at], last);
  }
  return became;
}

}  // namespace

// Keeps the order of the vertices and triangles that are left.
TriangleMesh CollapseSequence::after(std::size_t count, std::vector<std::uint32_t>* vertex_origins) const {
  std::vector<Eigen::Vector3f> positions = start.positions;
  for (std::size_t i = 0; i < count; ++i) positions[collapses[i].kept] = collapses[i].position;
  const std::vector<std::uint32_t> now = vertices_after(*this, count);
  TriangleMesh mesh;
  mesh.triangles.reserve(static_cast<std::size_t>(faces_after(count)));
  std::vector<std::uint32_t> new_index(positions.size(), 0);
  for (const Triangle& triangle : start.triangles) {
    const Triangle left = {now[triangle[0]], now[triangle[1]], now[triangle[2]]};
    if (left[0] == left[1] || left[1] == left[2] || left[2] == left[0]) continue;
    for (std::uint32_t vertex : left) new_index[vertex] = 1;
    mesh.triangles.push_back(left);
  }
  if (vertex_origins != nullptr) vertex_origins->clear();
  for (std::uint32_t i = 0; i < new_index.size(); ++i) {
    if (new_index[i] == 0) continue;
    new_index[i] = static_cast<std::uint32_t>(mesh.positions.size());
    mesh.positions.push_back(positions[i]);
    if (vertex_origins != nullptr) vertex_origins->push_back(i);
  }
  for (Triangle& triangle : mesh.triangles)
    for (std::uint32_t& vertex : triangle) vertex = new_index[vertex];
  return mesh;
}

std::vector<VertexPair> surviving_edges(const CollapseSequence& sequence, std::size_t count,
                                        std::span<const VertexPair> edges) {
  if (edges.empty()) return {};
  std::vector<std::uint32_t> origins;
  sequence.after(count, &origins);
  const std::vector<std::uint32_t> now = vertices_after(sequence, count);
  constexpr std::uint32_t none = ~0u;
  std::vector<std::uint32_t> new_index(now.size(), none);
  for (std::uint32_t i = 0; i < origins.size(); ++i) new_index[origins[i]] = i;
  std::vector<VertexPair> left;
  for (const auto& [a, b] : edges)
    if (now[a] != now[b] && new_index[now[a]] != none && new_index[now[b]] != none)
      left.emplace_back(std::minmax(new_index[now[a]], new_index[now[b]]));
  std::sort(left.begin(), left.end());
  left.erase(std::unique(left.begin(), left.end()), left.end());
  return left;
}

}  // namespace kiln
