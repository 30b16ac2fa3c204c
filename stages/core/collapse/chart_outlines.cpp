// SPDX-License-Identifier: GPL-3.0-or-later
#include "collapse/chart_outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "collapse/uv_plane.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_edge = ~0u;
constexpr double lookup_texels = 0.5;  // that a bilinear lookup reaches beyond its place

std::uint64_t key_of(std::uint32_t high, std::uint32_t low) { return static_cast<std::uint64_t>(high) << 32 | low; }

using Corners = std::array<Eigen::Vector2d, 3>;  // counter-clockwise

bool holds(const Corners& corners, const Eigen::Vector2d& point) {
  return turn(corners[0], corners[1], point) >= 0 && turn(corners[1], corners[2], point) >= 0 &&
         turn(corners[2], corners[0], point) >= 0;
}

/// Returns the squared distance of a point from a segment.
double squared_distance(const Eigen::Vector2d& point, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double length = (b - a).squaredNorm();
  const double place = length > 0 ? std::clamp((point - a).dot(b - a) / length, 0.0, 1.0) : 0;
  return (a + place * (b - a) - point).squaredNorm();
}

/// Tells whether two segments cross at a point within both.
bool cross_each_other(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                      const Eigen::Vector2d& d) {
  const double c_side = turn(a, b, c), d_side = turn(a, b, d), a_side = turn(c, d, a), b_side = turn(c, d, b);
  return c_side * d_side <= 0 && a_side * b_side <= 0 && !(c_side == 0 && d_side == 0);
}

/// Tells whether a segment touches a triangle elsewhere than at the corners where it may end.
bool enters(const Corners& corners, const Eigen::Vector2d& p, const Eigen::Vector2d& q) {
  const auto corner_of = [&](const Eigen::Vector2d& point) {
    return static_cast<std::size_t>(std::find(corners.begin(), corners.end(), point) - corners.begin());
  };
  const std::size_t at_p = corner_of(p), at_q = corner_of(q);
  if (at_p < 3 && at_q < 3) return true;
  if (at_p < 3 || at_q < 3) {
    const std::size_t k = std::min(at_p, at_q);
    const Eigen::Vector2d& far = at_p < 3 ? q : p;
    return turn(corners[k], corners[(k + 1) % 3], far) > 0 && turn(corners[(k + 2) % 3], corners[k], far) > 0;
  }
  if (holds(corners, p) || holds(corners, q)) return true;
  for (std::size_t k = 0; k < 3; ++k)
    if (cross_each_other(corners[k], corners[(k + 1) % 3], p, q)) return true;
  return false;
}

}  // namespace

ChartOutlines::ChartOutlines(const WedgeMesh& wedges, std::vector<Eigen::Vector2d> uvs, double overhang,
                             double farthest_overhang)
    : uvs_(std::move(uvs)), overhang_(overhang), farthest_overhang_(farthest_overhang) {
  const std::vector<std::array<std::uint32_t, 2>> outline = wedges.outline();
  double length = 0;
  for (const auto& [from, to] : outline) length += (uvs_[to] - uvs_[from]).norm();
  cell_size_ = outline.empty() ? 1 : std::max(1e-3, 2 * length / static_cast<double>(outline.size()));
  for (const auto& [from, to] : outline) add({from, to, true, {}});
}

template <class Visit>
void ChartOutlines::visit_cells(const Eigen::Vector2d& lowest, const Eigen::Vector2d& highest,
                                const Visit& visit) const {
  const auto cell = [&](double value) { return static_cast<std::int32_t>(std::floor(value / cell_size_)); };
  for (std::int32_t j = cell(lowest.y()); j <= cell(highest.y()); ++j)
    for (std::int32_t i = cell(lowest.x()); i <= cell(highest.x()); ++i)
      visit(key_of(static_cast<std::uint32_t>(j), static_cast<std::uint32_t>(i)));
}

void ChartOutlines::add(Edge edge) {
  const auto index = static_cast<std::uint32_t>(edges_.size());
  const Eigen::Vector2d &a = uvs_[edge.from], &b = uvs_[edge.to];
  visit_cells(a.cwiseMin(b), a.cwiseMax(b), [&](std::uint64_t cell) { in_cell_[cell].push_back(index); });
  edge_at_[key_of(edge.from, edge.to)] = index;
  edges_.push_back(std::move(edge));
}

std::uint32_t ChartOutlines::edge_of(std::uint32_t from, std::uint32_t to) const {
  const auto found = edge_at_.find(key_of(from, to));
  return found == edge_at_.end() ? no_edge : found->second;
}

/// Tells whether the uvs run on across the line, as they do at a hard edge within a chart: what one side gains there
/// the other loses.
bool ChartOutlines::is_continuous(const WedgeCollapse& collapse) const {
  if (collapse.sectors.size() != 2) return false;
  const WedgeCollapse::Sector &one = collapse.sectors[0], &other = collapse.sectors[1];
  return uvs_[one.from_wedge] == uvs_[other.from_wedge] && uvs_[one.before] == uvs_[other.after] &&
         uvs_[one.after] == uvs_[other.before];
}

/// Returns how far the first outline would lie inside the chart; below 0 where the chart draws back from it everywhere.
double ChartOutlines::overhang(const WedgeCollapse::Sector& sector, double side) const {
  const Eigen::Vector2d &a = uvs_[sector.before], &b = uvs_[sector.after];
  const double length = (b - a).norm();
  if (length == 0) return std::numeric_limits<double>::infinity();
  double most = side * turn(a, b, uvs_[sector.from_wedge]) / length;
  for (const std::uint32_t edge : {edge_of(sector.before, sector.from_wedge), edge_of(sector.from_wedge, sector.after)})
    if (edge != no_edge)
      for (const Eigen::Vector2d& point : edges_[edge].dropped)
        most = std::max(most, side * turn(a, b, point) / length);
  return most;
}

/// Tells whether no outline in a box hits, but for those that the collapse does away with.
template <class Hits>
bool ChartOutlines::none_near(const WedgeCollapse& collapse, const Eigen::Vector2d& lowest,
                              const Eigen::Vector2d& highest, const Hits& hits) const {
  const auto goes = [&](const Edge& edge) {
    return std::any_of(collapse.sectors.begin(), collapse.sectors.end(), [&](const WedgeCollapse::Sector& sector) {
      return edge.from == sector.from_wedge || edge.to == sector.from_wedge;
    });
  };
  bool none = true;
  visit_cells(lowest, highest, [&](std::uint64_t cell) {
    const auto found = in_cell_.find(cell);
    if (!none || found == in_cell_.end()) return;
    for (const std::uint32_t index : found->second) {
      const Edge& edge = edges_[index];
      if (edge.there && !goes(edge) && hits(edge)) none = false;
    }
  });
  return none;
}

/// Tells whether all outlines but those next to it are so far from what the sector's will be.
bool ChartOutlines::has_room(const WedgeCollapse& collapse, const WedgeCollapse::Sector& sector, double room) const {
  const Eigen::Vector2d &a = uvs_[sector.before], &b = uvs_[sector.after];
  const Eigen::Vector2d around(room, room);
  return none_near(collapse, a.cwiseMin(b) - around, a.cwiseMax(b) + around, [&](const Edge& edge) {
    for (const std::uint32_t end : {edge.from, edge.to})
      if (end == sector.before || end == sector.after) return false;
    const Eigen::Vector2d &p = uvs_[edge.from], &q = uvs_[edge.to];
    return std::min({squared_distance(p, a, b), squared_distance(q, a, b), squared_distance(a, p, q),
                     squared_distance(b, p, q)}) < room * room;
  });
}

/// Tells whether no other outline comes into what the chart would gain.
bool ChartOutlines::is_clear(const WedgeCollapse& collapse, const WedgeCollapse::Sector& sector) const {
  Corners gained = {uvs_[sector.before], uvs_[sector.after], uvs_[sector.from_wedge]};
  if (turn(gained[0], gained[1], gained[2]) < 0) std::swap(gained[0], gained[1]);
  return none_near(collapse, gained[0].cwiseMin(gained[1]).cwiseMin(gained[2]),
                   gained[0].cwiseMax(gained[1]).cwiseMax(gained[2]),
                   [&](const Edge& edge) { return enters(gained, uvs_[edge.from], uvs_[edge.to]); });
}

bool ChartOutlines::allow(const WedgeMesh& wedges, const WedgeCollapse& collapse) const {
  if (!collapse.on_line || is_continuous(collapse)) return true;
  return std::all_of(collapse.sectors.begin(), collapse.sectors.end(), [&](const WedgeCollapse::Sector& sector) {
    const Triangle& t = wedges.wedges(sector.triangles[0]);
    const double side = turn(uvs_[t[0]], uvs_[t[1]], uvs_[t[2]]) < 0 ? -1 : 1;  // charts may be mirrored
    const double texels = overhang(sector, side);
    if (texels > farthest_overhang_) return false;
    if (texels > overhang_ && !has_room(collapse, sector, texels + lookup_texels)) return false;
    const bool gains = side * turn(uvs_[sector.before], uvs_[sector.after], uvs_[sector.from_wedge]) > 0;
    return !gains || is_clear(collapse, sector);
  });
}

void ChartOutlines::apply(const WedgeCollapse& collapse) {
  if (!collapse.on_line) return;
  for (const WedgeCollapse::Sector& sector : collapse.sectors) {
    Edge joined{sector.before, sector.after, true, {}};
    const auto take = [&](std::uint32_t index) {
      if (index == no_edge) return;
      Edge& edge = edges_[index];
      joined.dropped.insert(joined.dropped.end(), edge.dropped.begin(), edge.dropped.end());
      edge_at_.erase(key_of(edge.from, edge.to));
      edge.there = false;
      edge.dropped.clear();
    };
    take(edge_of(sector.before, sector.from_wedge));
    joined.dropped.push_back(uvs_[sector.from_wedge]);
    take(edge_of(sector.from_wedge, sector.after));
    add(std::move(joined));
  }
}

}  // namespace kiln
