// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <boost/container/small_vector.hpp>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "simplify/feature_edges.h"

namespace kiln {

/// Graph of a mesh's feature edges, kept up while edges are collapsed.
class FeatureGraph {
 public:
  /// Takes the number of vertices, and feature edges between them, each once.
  FeatureGraph(std::size_t vertices, std::span<const VertexPair> feature_edges);

  /// Returns the other ends of the feature edges at a vertex: 2 inside a line, another number at its ends and branches.
  std::span<const std::uint32_t> neighbours(std::uint32_t vertex) const {
    return {neighbours_[vertex].data(), neighbours_[vertex].size()};
  }

  /// Tells whether two vertices are the ends of a feature edge.
  bool contains(std::uint32_t a, std::uint32_t b) const;

  /// Makes `removed` into `kept`. An edge between them is gone; edges that become one count once.
  void collapse(std::uint32_t removed, std::uint32_t kept);

 private:
  std::vector<boost::container::small_vector<std::uint32_t, 2>> neighbours_;
};

}  // namespace kiln
