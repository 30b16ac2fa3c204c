// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/feature_graph.h"

#include <algorithm>

namespace kiln {

FeatureGraph::FeatureGraph(std::size_t vertices, std::span<const VertexPair> feature_edges) : neighbours_(vertices) {
  for (const auto& [a, b] : feature_edges) {
    neighbours_[a].push_back(b);
    neighbours_[b].push_back(a);
  }
}

bool FeatureGraph::contains(std::uint32_t a, std::uint32_t b) const {
  return std::find(neighbours_[a].begin(), neighbours_[a].end(), b) != neighbours_[a].end();
}

void FeatureGraph::collapse(std::uint32_t removed, std::uint32_t kept) {
  const auto erase = [&](std::uint32_t vertex, std::uint32_t other) {
    auto& list = neighbours_[vertex];
    list.erase(std::remove(list.begin(), list.end(), other), list.end());
  };
  for (const std::uint32_t other : neighbours_[removed]) {
    erase(other, removed);
    if (other == kept || contains(kept, other)) continue;
    neighbours_[kept].push_back(other);
    neighbours_[other].push_back(kept);
  }
  neighbours_[removed].clear();
}

}  // namespace kiln
