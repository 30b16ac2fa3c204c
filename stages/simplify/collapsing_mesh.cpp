// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/collapsing_mesh.h"

#include <algorithm>

namespace kiln {

namespace {

int corner_of(const Triangle& triangle, std::uint32_t vertex) {
  return triangle[0] == vertex ? 0 : triangle[1] == vertex ? 1 : 2;
}

}  // namespace

CollapsingMesh::CollapsingMesh(const TriangleMesh& mesh, std::span<const VertexPair> feature_edges)
    : triangles_(mesh.triangles),
      feature_bits_(mesh.triangles.size(), 0),
      feature_counts_(mesh.positions.size(), 0),
      around_(mesh.positions.size()),
      faces_(static_cast<int>(mesh.triangles.size())),
      mark_(mesh.positions.size(), 0) {
  for (const Triangle& triangle : triangles_)
    for (std::uint32_t vertex : triangle) ++around_[vertex].capacity;
  std::uint32_t end = 0;
  for (Around& around : around_) {
    around.begin = end;
    end += around.capacity;
  }
  pool_.reserve(2 * std::size_t{end});
  pool_.resize(end);
  for (std::uint32_t i = 0; i < triangles_.size(); ++i)
    for (std::uint32_t vertex : triangles_[i]) pool_[around_[vertex].begin + around_[vertex].size++] = i;
  for (const auto& [a, b] : feature_edges) {
    mark_feature(a, b);
    for (std::uint32_t vertex : {a, b}) feature_counts_[vertex] = std::min(feature_counts_[vertex] + 1, 200);
  }
}

bool CollapsingMesh::has_feature(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const {
  const int ka = corner_of(triangles_[triangle], a), kb = corner_of(triangles_[triangle], b);
  return is_feature(triangle, (ka + 1) % 3 == kb ? ka : kb);
}

void CollapsingMesh::mark_feature(std::uint32_t a, std::uint32_t b) {
  for (std::uint32_t triangle : triangles_of(a)) {
    const Triangle& t = triangles_[triangle];
    if (t[0] != b && t[1] != b && t[2] != b) continue;
    const int ka = corner_of(t, a), kb = corner_of(t, b);
    feature_bits_[triangle] |= static_cast<std::uint8_t>(1 << ((ka + 1) % 3 == kb ? ka : kb));
  }
}

void CollapsingMesh::feature_neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& neighbours) const {
  neighbours.clear();
  if (feature_counts_[vertex] == 0) return;
  const auto add = [&](std::uint32_t other) {
    if (std::find(neighbours.begin(), neighbours.end(), other) == neighbours.end()) neighbours.push_back(other);
  };
  for (std::uint32_t triangle : triangles_of(vertex)) {
    const Triangle& t = triangles_[triangle];
    const int k = corner_of(t, vertex);
    if (is_feature(triangle, k)) add(t[(k + 1) % 3]);
    if (is_feature(triangle, (k + 2) % 3)) add(t[(k + 2) % 3]);
  }
}

CollapsingMesh::Edge CollapsingMesh::edge(std::uint32_t a, std::uint32_t b) const {
  Edge edge;
  // Link condition [Dey 1999]: the vertices next to both ends are those of the
  // triangles on the edge.
  mark_now_ += 2;
  const std::uint32_t near_a = mark_now_, near_both = mark_now_ + 1;
  std::uint32_t opposite[2] = {};
  for (std::uint32_t triangle : triangles_of(a)) {
    const Triangle& t = triangles_[triangle];
    for (std::uint32_t vertex : t) mark_[vertex] = near_a;
    if (t[0] != b && t[1] != b && t[2] != b) continue;
    if (edge.triangles == 2) return edge;
    edge.at[edge.triangles] = triangle;
    opposite[edge.triangles++] = t[0] + t[1] + t[2] - a - b;
  }
  if (edge.triangles == 0) return edge;
  edge.feature = has_feature(edge.at[0], a, b);
  int common = 0;
  mark_[a] = mark_[b] = near_both;
  for (std::uint32_t triangle : triangles_of(b))
    for (std::uint32_t vertex : triangles_[triangle])
      if (mark_[vertex] == near_a) {
        mark_[vertex] = near_both;
        ++common;
      }
  if (common != edge.triangles) return edge;

  // Lines of feature edges do not become one, nor do the ends of one line meet; ends and branches stay.
  const int features_a = feature_counts_[a], features_b = feature_counts_[b];
  if (features_a > 0 && features_b > 0 && (!edge.feature || (features_a != 2 && features_b != 2))) return edge;
  for (int i = 0; i < edge.triangles; ++i) {
    if (has_feature(edge.at[i], a, opposite[i]) && has_feature(edge.at[i], b, opposite[i])) return edge;
    // Vertices of three triangles would be left with two that are back to back.
    if (around_[opposite[i]].size == 3 && feature_counts_[opposite[i]] == 0) return edge;
    if (around_[opposite[i]].size <= 1) return edge;
    if (around_[opposite[i]].size == 3 && common == 2) {
      // Count its neighbours: where feature edges pass it, it may lie inside the surface all the same.
      std::uint32_t seen[6];
      int vertices = 0;
      for (std::uint32_t triangle : triangles_of(opposite[i]))
        for (std::uint32_t vertex : triangles_[triangle])
          if (vertex != opposite[i] && std::find(seen, seen + vertices, vertex) == seen + vertices)
            seen[vertices++] = vertex;
      if (vertices == 3) return edge;
    }
  }
  edge.keeps_topology = true;
  return edge;
}

void CollapsingMesh::collapse(std::uint32_t removed, std::uint32_t kept) {
  // Remove the triangles on the edge. Of their two other edges, which become one, either may be a feature edge.
  const Edge between = edge(removed, kept);
  VertexPair merged_features[2];
  int merged_feature_count = 0;
  for (int i = 0; i < between.triangles; ++i) {
    const std::uint32_t gone = between.at[i];
    const Triangle t = triangles_[gone];
    const std::uint32_t opposite = t[0] + t[1] + t[2] - removed - kept;
    if (has_feature(gone, removed, opposite) || has_feature(gone, kept, opposite))
      merged_features[merged_feature_count++] = {kept, opposite};
    for (std::uint32_t vertex : t) {
      Around& around = around_[vertex];
      const auto begin = pool_.begin() + around.begin;
      const auto found = std::find(begin, begin + around.size, gone);
      std::copy(found + 1, begin + around.size, found);
      --around.size;
    }
    --faces_;
  }
  feature_counts_[kept] = static_cast<std::uint8_t>(
      std::min(200, feature_counts_[kept] + feature_counts_[removed] - 2 * int{between.feature}));
  feature_counts_[removed] = 0;

  // Give the other triangles of both vertices to `kept`.
  Around& left = around_[kept];
  Around& right = around_[removed];
  for (std::uint32_t i = 0; i < right.size; ++i)
    for (std::uint32_t& vertex : triangles_[pool_[right.begin + i]])
      if (vertex == removed) vertex = kept;
  Around both;
  both.size = left.size + right.size;
  if (both.size <= left.capacity) {
    std::copy_n(pool_.begin() + right.begin, right.size, pool_.begin() + left.begin + left.size);
    both.begin = left.begin;
    both.capacity = left.capacity;
  } else if (both.size <= right.capacity) {
    std::copy_n(pool_.begin() + left.begin, left.size, pool_.begin() + right.begin + right.size);
    both.begin = right.begin;
    both.capacity = right.capacity;
  } else {
    both.begin = static_cast<std::uint32_t>(pool_.size());
    both.capacity = both.size + both.size / 2;
    pool_.resize(pool_.size() + both.capacity);
    std::copy_n(pool_.begin() + left.begin, left.size, pool_.begin() + both.begin);
    std::copy_n(pool_.begin() + right.begin, right.size, pool_.begin() + both.begin + left.size);
  }
  left = both;
  right = {};
  for (int i = 0; i < merged_feature_count; ++i) mark_feature(merged_features[i].first, merged_features[i].second);
}

}  // namespace kiln
