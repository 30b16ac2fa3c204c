// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "simplify/feature_edges.h"

namespace kiln {

/// Connectivity of an oriented manifold whose edges are collapsed one by one: the triangles around each vertex, and
/// which edges are feature edges. Positions are up to whoever holds it.
class CollapsingMesh {
 public:
  CollapsingMesh(const TriangleMesh& mesh, std::span<const VertexPair> feature_edges);

  const std::vector<Triangle>& triangles() const { return triangles_; }
  std::span<const std::uint32_t> triangles_of(std::uint32_t vertex) const {
    return {pool_.data() + around_[vertex].begin, around_[vertex].size};
  }
  bool is_removed(std::uint32_t vertex) const { return around_[vertex].size == 0; }
  int faces() const { return faces_; }

  /// Counts the feature edges at a vertex: 2 inside a line of them, another number at its ends and branches.
  int feature_count(std::uint32_t vertex) const { return feature_counts_[vertex]; }
  /// Tells whether corner k of the triangle and the next corner are the ends of a feature edge.
  bool is_feature(std::uint32_t triangle, int corner) const { return (feature_bits_[triangle] >> corner & 1) != 0; }
  /// Lists in `neighbours` the other ends of the feature edges at `vertex`, each once.
  void feature_neighbours(std::uint32_t vertex, std::vector<std::uint32_t>& neighbours) const;

  /// Findings about an edge before it is collapsed.
  struct Edge {
    int triangles = 0;            ///< count of those on it: 1 at a border
    std::uint32_t at[2] = {};     ///< indices of those triangles
    bool feature = false;         ///< true for a feature edge
    bool keeps_topology = false;  ///< true where a collapse keeps the surface's topology, and makes no two lines one
  };
  Edge edge(std::uint32_t a, std::uint32_t b) const;

  /// Makes `removed` into `kept`. Needs edge(removed, kept).keeps_topology.
  void collapse(std::uint32_t removed, std::uint32_t kept);

 private:
  struct Around {
    std::uint32_t begin = 0, size = 0, capacity = 0;
  };
  void mark_feature(std::uint32_t a, std::uint32_t b);
  bool has_feature(std::uint32_t triangle, std::uint32_t a, std::uint32_t b) const;

  std::vector<Triangle> triangles_;
  std::vector<std::uint8_t> feature_bits_;    ///< by triangle: bit k is set where is_feature(triangle, k)
  std::vector<std::uint8_t> feature_counts_;  ///< by vertex, 200 at most
  std::vector<Around> around_;                ///< by vertex: where its triangles are in pool_
  std::vector<std::uint32_t> pool_;
  int faces_ = 0;
  mutable std::vector<std::uint32_t> mark_;  ///< by vertex: what edge() noted last, told apart by mark_now_
  mutable std::uint32_t mark_now_ = 0;
};

}  // namespace kiln
