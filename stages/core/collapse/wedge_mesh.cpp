// SPDX-License-Identifier: GPL-3.0-or-later
// Wedges are the corners' attributes of [Hoppe 1999]; a collapse keeps to half-edges, so that no vertex moves.
#include "collapse/wedge_mesh.h"

#include <algorithm>
#include <span>

#include "mesh/disjoint_sets.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

/// Triangle about a point in the order of a walk around it: (point, next, last) by winding.
struct WedgeMesh::Spoke {
  std::uint32_t triangle = 0;
  std::uint32_t own = 0, next = 0, last = 0;  ///< wedges
  bool starts_on_line = false;                ///< the edge to `next` is of a line
};

namespace {

/// Pairs the sides of one edge: first those of the same vertices, then the last two that are left. Returns false where
/// more than two are left that cannot be told apart.
template <class Join>
bool pair_sides(std::span<const Triangle> triangles, std::span<const Triangle> places,
                std::span<const std::uint32_t> sides, const Join& join) {
  std::vector<std::uint32_t> left;
  for (const std::uint32_t side : sides) {
    const auto same = std::find_if(left.begin(), left.end(), [&](std::uint32_t other) {
      return vertex_at(triangles, side) == vertex_at(triangles, next_corner(other)) &&
             vertex_at(triangles, other) == vertex_at(triangles, next_corner(side));
    });
    if (same == left.end())
      left.push_back(side);
    else
      left.erase(same);  // the vertices are joined by being the same
  }
  if (left.size() == 2 && run_opposite(places, left[0], left[1])) join(left[0], left[1]);
  return left.size() <= 2;
}

}  // namespace

WedgeMesh::WedgeMesh(const TriangleMesh& mesh)
    : wedges_(mesh.triangles),
      there_(mesh.triangles.size(), 1),
      triangle_count_(static_cast<int>(mesh.triangles.size())) {
  // Join the vertices of either side of a seam.
  const std::vector<Triangle> places = renumbered(mesh.triangles, first_at_position(mesh.positions));
  DisjointSets sets(mesh.positions.size());
  std::vector<std::uint32_t> unclear;  // vertices
  TriangleEdges(places).for_each([&](std::span<const std::uint32_t> sides) {
    const bool clear = pair_sides(mesh.triangles, places, sides, [&](std::uint32_t side, std::uint32_t other) {
      sets.join(vertex_at(mesh.triangles, side), vertex_at(mesh.triangles, next_corner(other)));
      sets.join(vertex_at(mesh.triangles, next_corner(side)), vertex_at(mesh.triangles, other));
    });
    if (!clear)
      for (const std::uint32_t side : sides)
        for (const std::uint32_t corner : {side, next_corner(side)})
          unclear.push_back(vertex_at(mesh.triangles, corner));
  });
  std::uint32_t count = 0;
  point_of_ = without_gaps(sets.roots(), &count);
  triangles_of_.resize(count);
  stays_.assign(count, 0);
  for (const std::uint32_t vertex : unclear) stays_[point_of_[vertex]] = 1;
  for (std::uint32_t t = 0; t < wedges_.size(); ++t)
    for (const std::uint32_t wedge : wedges_[t]) triangles_of_[point_of_[wedge]].push_back(t);

  // Points whose triangles are not one fan stay.
  for (std::uint32_t point = 0; point < count; ++point) {
    bool closed = false;
    if (spokes_about(point, closed).size() != triangles_of_[point].size()) stays_[point] = 1;
  }
}

std::size_t WedgeMesh::corner_at(std::uint32_t triangle, std::uint32_t point) const {
  for (std::size_t k = 0; k < 2; ++k)
    if (point_of_[wedges_[triangle][k]] == point) return k;
  return 2;
}

std::vector<std::uint32_t> WedgeMesh::neighbours(std::uint32_t point) const {
  std::vector<std::uint32_t> found;
  for (const std::uint32_t t : triangles_of_[point])
    for (const std::uint32_t wedge : wedges_[t])
      if (point_of_[wedge] != point) found.push_back(point_of_[wedge]);
  std::sort(found.begin(), found.end());
  found.erase(std::unique(found.begin(), found.end()), found.end());
  return found;
}

/// Walks around a point: counter-clockwise, from a border where there is one, else from its first line, else from its
/// first triangle. Returns fewer spokes than triangles where these are not one fan.
std::vector<WedgeMesh::Spoke> WedgeMesh::spokes_about(std::uint32_t point, bool& closed) const {
  const std::vector<std::uint32_t>& triangles = triangles_of_[point];
  std::vector<Spoke> all, walk;
  for (const std::uint32_t t : triangles) {
    const std::size_t k = corner_at(t, point);
    all.push_back({t, wedges_[t][k], wedges_[t][(k + 1) % 3], wedges_[t][(k + 2) % 3]});
  }
  closed = false;
  if (all.empty()) return walk;
  const auto before = [&](const Spoke& spoke) {
    return std::find_if(all.begin(), all.end(),
                        [&](const Spoke& other) { return point_of_[other.last] == point_of_[spoke.next]; });
  };
  auto first = std::find_if(all.begin(), all.end(), [&](const Spoke& spoke) { return before(spoke) == all.end(); });
  closed = first == all.end();
  for (Spoke& spoke : all) {
    const auto other = before(spoke);
    spoke.starts_on_line = other == all.end() || other->own != spoke.own || other->last != spoke.next;
  }
  if (closed) first = std::find_if(all.begin(), all.end(), [](const Spoke& spoke) { return spoke.starts_on_line; });
  if (first == all.end()) first = all.begin();
  for (auto spoke = first; spoke != all.end() && walk.size() < all.size();) {
    walk.push_back(*spoke);
    const std::uint32_t onwards = point_of_[spoke->last];
    if (closed && onwards == point_of_[first->next]) break;
    spoke = std::find_if(all.begin(), all.end(), [&](const Spoke& s) { return point_of_[s.next] == onwards; });
  }
  return walk;
}

/// Tests the link condition: the points next to both ends are those of the triangles on the edge.
bool WedgeMesh::keeps_manifold(std::uint32_t from, std::uint32_t to, std::size_t triangles_on_edge) const {
  const std::vector<std::uint32_t> a = neighbours(from), b = neighbours(to);
  std::vector<std::uint32_t> both;
  std::set_intersection(a.begin(), a.end(), b.begin(), b.end(), std::back_inserter(both));
  return both.size() == triangles_on_edge;
}

std::vector<WedgeCollapse> WedgeMesh::collapses_of(std::uint32_t point) const {
  std::vector<WedgeCollapse> found;
  if (stays_[point] != 0 || triangles_of_[point].empty()) return found;
  bool closed = false;
  const std::vector<Spoke> spokes = spokes_about(point, closed);
  const std::size_t count = spokes.size();
  if (count != triangles_of_[point].size()) return found;

  // A sector begins where a line does; beside a border the last one ends with it.
  std::vector<std::size_t> starts;
  for (std::size_t i = 0; i < count; ++i)
    if (spokes[i].starts_on_line) starts.push_back(i);
  const std::size_t lines = starts.size() + (closed ? 0 : 1);
  if (lines != 0 && lines != 2) return found;
  if (lines == 0) {
    std::vector<std::uint32_t> all;
    for (const Spoke& spoke : spokes) all.push_back(spoke.triangle);
    if (count < 3) return found;
    for (const Spoke& spoke : spokes) {
      const std::uint32_t to = point_of_[spoke.next];
      if (keeps_manifold(point, to, 2))
        found.push_back({point, to, false, {{all, spoke.own, spoke.next, spoke.next, spoke.next}}});
    }
    return found;
  }

  // Collapse along the line, to either end. A sector of one triangle would vanish with its corner of the chart.
  std::vector<WedgeCollapse::Sector> sectors;
  for (std::size_t s = 0; s < starts.size(); ++s) {
    const std::size_t end = s + 1 < starts.size() ? starts[s + 1] : count;
    WedgeCollapse::Sector sector{{}, spokes[starts[s]].own, 0, spokes[end - 1].last, spokes[starts[s]].next};
    for (std::size_t i = starts[s]; i < end; ++i) sector.triangles.push_back(spokes[i].triangle);
    if (sector.triangles.size() < 2) return found;
    sectors.push_back(std::move(sector));
  }
  for (const std::uint32_t to_wedge : {sectors[0].before, sectors[0].after}) {
    const std::uint32_t to = point_of_[to_wedge];
    if (!keeps_manifold(point, to, closed ? 2 : 1)) continue;
    WedgeCollapse collapse{point, to, true, sectors};
    for (WedgeCollapse::Sector& sector : collapse.sectors)
      sector.to_wedge = point_of_[sector.before] == to ? sector.before : sector.after;
    found.push_back(std::move(collapse));
  }
  return found;
}

void WedgeMesh::apply(const WedgeCollapse& collapse) {
  for (const WedgeCollapse::Sector& sector : collapse.sectors)
    for (const std::uint32_t t : sector.triangles) {
      Triangle& triangle = wedges_[t];
      const bool vanishes = std::any_of(triangle.begin(), triangle.end(),
                                        [&](std::uint32_t wedge) { return point_of_[wedge] == collapse.to; });
      if (!vanishes) {
        triangle[corner_at(t, collapse.from)] = sector.to_wedge;
        triangles_of_[collapse.to].push_back(t);
        continue;
      }
      there_[t] = 0;
      --triangle_count_;
      for (const std::uint32_t wedge : triangle) std::erase(triangles_of_[point_of_[wedge]], t);
    }
  triangles_of_[collapse.from].clear();
}

std::vector<std::array<std::uint32_t, 2>> WedgeMesh::outline() const {
  std::vector<std::array<std::uint32_t, 2>> found;
  for (std::uint32_t point = 0; point < point_count(); ++point) {
    bool closed = false;
    const std::vector<Spoke> spokes = spokes_about(point, closed);
    for (const Spoke& spoke : spokes)
      if (spoke.starts_on_line) found.push_back({spoke.own, spoke.next});
    // The other sides of lines start at their other ends, but where the point's triangles are not one fan.
  }
  return found;
}

std::vector<Triangle> WedgeMesh::triangles() const {
  std::vector<Triangle> left;
  for (std::size_t t = 0; t < wedges_.size(); ++t)
    if (there_[t] != 0) left.push_back(wedges_[t]);
  return left;
}

}  // namespace kiln
