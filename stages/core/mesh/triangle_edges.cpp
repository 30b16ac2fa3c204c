// SPDX-License-Identifier: MIT
#include "mesh/triangle_edges.h"

#include <algorithm>

namespace kiln {

EdgeKey edge_at(std::span<const Triangle> triangles, std::uint32_t corner) {
  return std::minmax({vertex_at(triangles, corner), vertex_at(triangles, next_corner(corner))});
}

TriangleEdges::TriangleEdges(std::span<const Triangle> triangles) {
  // Step 1: count the sides by the lesser end of their edges.
  std::uint32_t most = 0;
  for (const Triangle& t : triangles) most = std::max({most, t[0], t[1], t[2]});
  std::vector<std::uint32_t> first(std::size_t{most} + 2, 0);
  const auto corners = static_cast<std::uint32_t>(3 * triangles.size());
  for (std::uint32_t corner = 0; corner < corners; ++corner) ++first[edge_at(triangles, corner).first + 1];
  for (std::size_t v = 1; v < first.size(); ++v) first[v] += first[v - 1];

  // Step 2: list them by that end, then sort each short list by the other end.
  std::vector<std::pair<std::uint32_t, std::uint32_t>> listed(corners);  // the greater end, and the side
  std::vector<std::uint32_t> next(first.begin(), first.end() - 1);
  for (std::uint32_t corner = 0; corner < corners; ++corner) {
    const auto [low, high] = edge_at(triangles, corner);
    listed[next[low]++] = {high, corner};
  }
  sides_.resize(corners);
  keys_.resize(corners);
  for (std::uint32_t low = 0; low <= most; ++low) {
    std::sort(listed.begin() + first[low], listed.begin() + first[low + 1]);
    for (std::uint32_t k = first[low]; k < first[low + 1]; ++k) {
      sides_[k] = listed[k].second;
      keys_[k] = {low, listed[k].first};
    }
  }
}

std::vector<Triangle> renumbered(std::span<const Triangle> triangles, std::span<const std::uint32_t> number) {
  std::vector<Triangle> result;
  result.reserve(triangles.size());
  for (const Triangle& t : triangles) result.push_back({number[t[0]], number[t[1]], number[t[2]]});
  return result;
}

}  // namespace kiln
