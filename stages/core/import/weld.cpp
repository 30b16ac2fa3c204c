// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/weld.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <span>
#include <unordered_map>

#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr std::uint32_t none = ~0u;

struct KeyHash {
  std::size_t operator()(const std::array<std::int64_t, 3>& key) const {
    std::uint64_t hash = 0;
    for (const std::int64_t word : key) {
      hash = (hash ^ static_cast<std::uint64_t>(word)) * 0x9e3779b97f4a7c15u;
      hash ^= hash >> 29;
    }
    return hash;
  }
};
template <class Value>
using Table = std::unordered_map<std::array<std::int64_t, 3>, Value, KeyHash>;

/// Returns a number of its own for every position.
std::vector<std::uint32_t> identity(std::size_t size) {
  std::vector<std::uint32_t> number(size);
  std::iota(number.begin(), number.end(), 0u);
  return number;
}

bool any_border(const std::vector<double>& shortest) {
  return std::any_of(shortest.begin(), shortest.end(), [](double length) { return std::isfinite(length); });
}

/// Returns the squared length of the shortest edge at each position on a border, by its number; infinity elsewhere.
std::vector<double> shortest_border_edges(const SourceMesh& source, const std::vector<CutTriangle>& triangles,
                                          const std::vector<std::uint32_t>& number) {
  std::vector<double> shortest(source.places.size(), std::numeric_limits<double>::infinity());
  std::vector<Triangle> welded;
  welded.reserve(triangles.size());
  for (const CutTriangle& triangle : triangles) {
    const auto place = [&](std::size_t k) { return number[source.corners[triangle.corners[k]].place]; };
    welded.push_back({place(0), place(1), place(2)});
  }
  std::vector<bool> on_border(source.places.size(), false);
  TriangleEdges(welded).for_each([&](std::span<const std::uint32_t> sides) {
    const auto [a, b] = edge_at(welded, sides[0]);
    if (a == b) return;
    const double length = (source.places[a] - source.places[b]).squaredNorm();
    shortest[a] = std::min(shortest[a], length);
    shortest[b] = std::min(shortest[b], length);
    if (sides.size() == 1) on_border[a] = on_border[b] = true;
  });
  for (std::size_t i = 0; i < shortest.size(); ++i)
    if (!on_border[i]) shortest[i] = std::numeric_limits<double>::infinity();
  return shortest;
}

double weld_distance(const SourceMesh& source, const std::vector<CutTriangle>& triangles, const WeldChoice& choice) {
  const double size = box_of(source, triangles).diagonal().norm();
  // The search counts cells in whole numbers, which bounds the distance from below.
  if (choice.kind == WeldChoice::Kind::distance) return std::max(choice.distance, 1e-15 * size);
  return std::clamp(2 * source.precision, std::ldexp(size, -22), 1e-6 * size);
}

}  // namespace

int weld_borders(SourceMesh& source, const std::vector<CutTriangle>& triangles, const WeldChoice& choice) {
  if (choice.kind == WeldChoice::Kind::off) return 0;
  const double distance = weld_distance(source, triangles, choice);
  if (!(distance > 0) || !std::isfinite(distance)) return 0;
  // Most files of closed surfaces show by their indices alone that they have no border.
  if (!any_border(shortest_border_edges(source, triangles, identity(source.places.size())))) return 0;
  const std::vector<std::uint32_t> number = first_at_position(source.places);
  const std::vector<double> shortest = shortest_border_edges(source, triangles, number);

  // Cells are as wide as the distance and hold the positions that others may move onto, so 27 of them are searched.
  const Eigen::Vector3d origin = triangles.empty() ? Eigen::Vector3d(Eigen::Vector3d::Zero())
                                                   : source.places[source.corners[triangles[0].corners[0]].place];
  Table<std::vector<std::uint32_t>> cells;
  std::vector<std::uint32_t> kept(source.places.size(), none);
  const auto find = [&](std::uint32_t i, const std::array<std::int64_t, 3>& cell) {
    for (std::int64_t dx = -1; dx <= 1; ++dx)
      for (std::int64_t dy = -1; dy <= 1; ++dy)
        for (std::int64_t dz = -1; dz <= 1; ++dz) {
          const auto found = cells.find({cell[0] + dx, cell[1] + dy, cell[2] + dz});
          if (found == cells.end()) continue;
          for (const std::uint32_t other : found->second) {
            const double apart = (source.places[i] - source.places[other]).squaredNorm();
            if (apart <= distance * distance && 16 * apart < std::min(shortest[i], shortest[other])) return other;
          }
        }
    return none;
  };
  for (std::uint32_t i = 0; i < source.places.size(); ++i) {
    if (number[i] != i || !std::isfinite(shortest[i])) continue;
    std::array<std::int64_t, 3> cell;
    for (int k = 0; k < 3; ++k)
      cell[static_cast<std::size_t>(k)] = std::llround(std::floor((source.places[i][k] - origin[k]) / distance));
    kept[i] = find(i, cell);
    if (kept[i] == none) cells[cell].push_back(i);
  }
  int moved = 0;
  for (std::size_t i = 0; i < source.places.size(); ++i) {
    const std::uint32_t target = kept[number[i]];
    if (target == none) continue;
    source.places[i] = source.places[target];
    ++moved;
  }
  return moved;
}

}  // namespace kiln
