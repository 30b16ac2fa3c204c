// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// An edge of a mesh by its vertices, the lesser first.
using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;

/// Corner k of triangle t has the number 3 t + k, which also names the triangle's side that starts there.
constexpr std::uint32_t next_corner(std::uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; }

inline std::uint32_t vertex_at(std::span<const Triangle> triangles, std::uint32_t corner) {
  return triangles[corner / 3][corner % 3];
}

/// Returns the edge that a side lies on.
EdgeKey edge_at(std::span<const Triangle> triangles, std::uint32_t corner);

/// Tells whether two triangles run along the edge that these sides share in opposite directions, as neighbours on an
/// oriented surface do.
inline bool run_opposite(std::span<const Triangle> triangles, std::uint32_t side, std::uint32_t other) {
  return vertex_at(triangles, side) != vertex_at(triangles, other);
}

/// Sides of triangles, sorted by the edges that they lie on; those of one edge in the order of their corners. Takes
/// time in proportion to the triangles and the largest vertex.
class TriangleEdges {
 public:
  explicit TriangleEdges(std::span<const Triangle> triangles);

  /// Returns all sides in that order.
  const std::vector<std::uint32_t>& sides() const { return sides_; }

  /// Calls visit(sides) for each edge in order, with a span of the sides on it: one at a border, two inside a surface.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t begin = 0, end = 0; begin < sides_.size(); begin = end) {
      for (++end; end < sides_.size() && keys_[end] == keys_[begin];) ++end;
      visit(std::span(sides_).subspan(begin, end - begin));
    }
  }

 private:
  std::vector<std::uint32_t> sides_;
  std::vector<EdgeKey> keys_;  ///< by place in sides_
};

/// Returns the triangles with number[vertex] in place of each vertex.
std::vector<Triangle> renumbered(std::span<const Triangle> triangles, std::span<const std::uint32_t> number);

}  // namespace kiln
