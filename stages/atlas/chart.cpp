// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/chart.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <unordered_map>

#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

bool within_box(const Eigen::Vector2d& p, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return p.x() >= std::min(a.x(), b.x()) && p.x() <= std::max(a.x(), b.x()) && p.y() >= std::min(a.y(), b.y()) &&
         p.y() <= std::max(a.y(), b.y());
}

/// Tells whether two segments with no common end meet; touching counts.
bool segments_meet(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                   const Eigen::Vector2d& d) {
  const double abc = cross(a, b, c), abd = cross(a, b, d), cda = cross(c, d, a), cdb = cross(c, d, b);
  if (((abc > 0) != (abd > 0)) && ((cda > 0) != (cdb > 0)) && abc != 0 && abd != 0 && cda != 0 && cdb != 0) return true;
  return (abc == 0 && within_box(c, a, b)) || (abd == 0 && within_box(d, a, b)) || (cda == 0 && within_box(a, c, d)) ||
         (cdb == 0 && within_box(b, c, d));
}

}  // namespace

std::vector<BorderEdge> border_edges(const Chart& chart) {
  std::vector<BorderEdge> result;
  TriangleEdges(chart.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() == 1)
      result.push_back({vertex_at(chart.triangles, sides[0]), vertex_at(chart.triangles, next_corner(sides[0]))});
  });
  return result;
}

bool is_flip_free(const Chart& chart) {
  for (const Eigen::Vector2d& uv : chart.uvs)
    if (!uv.allFinite()) return false;
  return std::all_of(chart.triangles.begin(), chart.triangles.end(),
                     [&](const Triangle& t) { return cross(chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]) > 0; });
}

bool has_simple_border(const Chart& chart) {
  const std::vector<BorderEdge> border = border_edges(chart);
  if (border.empty()) return false;

  // Sort segments into a grid of cells about as large as a border segment; compare only those that share a cell.
  Eigen::Vector2d lowest = chart.uvs[border[0].from], highest = lowest;
  double length = 0;
  for (const BorderEdge& s : border) {
    lowest = lowest.cwiseMin(chart.uvs[s.from]);
    highest = highest.cwiseMax(chart.uvs[s.from]);
    length += (chart.uvs[s.to] - chart.uvs[s.from]).norm();
  }
  const double extent = (highest - lowest).maxCoeff();
  const double cell = std::max(length / static_cast<double>(border.size()), extent / 4096);
  if (!(cell > 0)) return false;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
  for (std::uint32_t index = 0; index < border.size(); ++index) {
    const Eigen::Vector2d a = (chart.uvs[border[index].from] - lowest) / cell,
                          b = (chart.uvs[border[index].to] - lowest) / cell;
    const auto [first_x, last_x] = std::minmax({static_cast<int>(a.x()), static_cast<int>(b.x())});
    const auto [first_y, last_y] = std::minmax({static_cast<int>(a.y()), static_cast<int>(b.y())});
    for (int y = first_y; y <= last_y; ++y)
      for (int x = first_x; x <= last_x; ++x) {
        std::vector<std::uint32_t>& neighbours =
            cells[(std::uint64_t(static_cast<std::uint32_t>(y)) << 32) | static_cast<std::uint32_t>(x)];
        for (const std::uint32_t other : neighbours) {
          const BorderEdge &s = border[index], &o = border[other];
          if (s.from == o.from || s.to == o.to) return false;  // the border passes through a vertex twice
          if (s.from == o.to || s.to == o.from) continue;
          if (segments_meet(chart.uvs[s.from], chart.uvs[s.to], chart.uvs[o.from], chart.uvs[o.to])) return false;
        }
        neighbours.push_back(index);
      }
  }
  return true;
}

bool keeps_clear(const Surface& surface, const Chart& chart, double distance) {
  if (!(distance > 0)) return true;
  const std::vector<BorderEdge> border = border_edges(chart);
  double perimeter = 0;
  for (const auto& [from, to] : border) perimeter += (chart.uvs[to] - chart.uvs[from]).norm();
  constexpr double most_samples = 20'000;  // besides one per edge
  distance = std::max(distance, 2 * perimeter / most_samples);
  struct Sample {
    Eigen::Vector2d uv;
    Eigen::Vector3d position;
  };
  std::vector<Sample> samples;
  for (const auto& [from, to] : border) {
    const Eigen::Vector3d a = surface.mesh->positions[chart.vertices[from]].cast<double>();
    const Eigen::Vector3d b = surface.mesh->positions[chart.vertices[to]].cast<double>();
    const double length = (chart.uvs[to] - chart.uvs[from]).norm();
    const int steps = 1 + static_cast<int>(2 * length / distance);
    for (int i = 0; i < steps; ++i) {
      const double t = (i + 0.5) / steps;
      samples.push_back({chart.uvs[from] + t * (chart.uvs[to] - chart.uvs[from]), a + t * (b - a)});
    }
  }
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> cells;
  const auto key = [](std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(y) << 32) ^ (static_cast<std::uint64_t>(x) & 0xffffffffu);
  };
  for (std::uint32_t i = 0; i < samples.size(); ++i) {
    const auto x = static_cast<std::int64_t>(std::floor(samples[i].uv.x() / distance));
    const auto y = static_cast<std::int64_t>(std::floor(samples[i].uv.y() / distance));
    for (std::int64_t dy = -1; dy <= 1; ++dy)
      for (std::int64_t dx = -1; dx <= 1; ++dx) {
        const auto cell = cells.find(key(x + dx, y + dy));
        if (cell == cells.end()) continue;
        for (const std::uint32_t other : cell->second)
          if ((samples[i].uv - samples[other].uv).squaredNorm() < distance * distance &&
              (samples[i].position - samples[other].position).squaredNorm() > 9 * distance * distance)
            return false;
      }
    cells[key(x, y)].push_back(i);
  }
  return true;
}

void equalise_area(const Surface& surface, Chart& chart) {
  double area = 0, uv_area = 0;
  for (std::size_t i = 0; i < chart.faces.size(); ++i) {
    const Triangle& t = chart.triangles[i];
    area += surface.rest[chart.faces[i]].area;
    uv_area += 0.5 * cross(chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]);
  }
  if (!(uv_area > 0)) return;
  const double scale = std::sqrt(area / uv_area);
  for (Eigen::Vector2d& uv : chart.uvs) uv *= scale;
}

}  // namespace kiln
