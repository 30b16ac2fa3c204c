// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <utility>

#include "atlas/surface.h"
#include "base/json.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"
#include "raycast/surface_transfer.h"

namespace kiln {

namespace {

double uv_area(const TriangleMesh& atlas, const Triangle& t) {
  return 0.5 * cross(atlas.uvs[t[0]].cast<double>(), atlas.uvs[t[1]].cast<double>(), atlas.uvs[t[2]].cast<double>());
}

/// Returns, for each vertex, the first one with the very same position and uv.
std::vector<std::uint32_t> first_at_position_and_uv(const TriangleMesh& atlas) {
  std::vector<float> values;
  values.reserve(5 * atlas.positions.size());
  for (std::size_t v = 0; v < atlas.positions.size(); ++v) {
    const Eigen::Vector3f& p = atlas.positions[v];
    values.insert(values.end(), {p.x(), p.y(), p.z(), atlas.uvs[v].x(), atlas.uvs[v].y()});
  }
  return first_of_equals(values, 5);
}

/// Edge of the surface across which the atlas is cut.
struct SeamEdge {
  std::uint32_t from, to;  ///< vertices of the atlas on one side of it
  double length = 0;
};

std::vector<SeamEdge> seam_edges(const TriangleMesh& atlas) {
  const std::vector<std::uint32_t> vertex = first_at_position_and_uv(atlas);
  std::vector<Triangle> shown;  // triangles of some uv area
  for (const Triangle& t : atlas.triangles)
    if (uv_area(atlas, t) != 0) shown.push_back({vertex[t[0]], vertex[t[1]], vertex[t[2]]});
  const std::vector<Triangle> welded = renumbered(shown, first_at_position(atlas.positions));
  std::vector<SeamEdge> seams;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ends;  // vertices of the atlas at an edge's ends, each pair once
  TriangleEdges(welded).for_each([&](std::span<const std::uint32_t> sides) {
    ends.clear();
    for (const std::uint32_t side : sides) {
      std::uint32_t a = side, b = next_corner(side);
      if (vertex_at(welded, a) > vertex_at(welded, b)) std::swap(a, b);
      ends.emplace_back(vertex_at(shown, a), vertex_at(shown, b));
    }
    std::sort(ends.begin(), ends.end());
    ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
      const auto& [from, to] = ends[i];
      seams.push_back({from, to, (atlas.positions[from] - atlas.positions[to]).cast<double>().norm()});
    }
  });
  return seams;
}

/// Sums the seams' lengths, weighted by how much of the sky their ends see.
double visible_length(const TriangleMesh& atlas, const std::vector<SeamEdge>& seams) {
  std::vector<std::uint32_t> index(atlas.positions.size(), no_index);
  std::vector<Eigen::Vector3f> positions, normals;
  for (const SeamEdge& edge : seams)
    for (const std::uint32_t vertex : {edge.from, edge.to}) {
      if (index[vertex] != no_index) continue;
      index[vertex] = static_cast<std::uint32_t>(positions.size());
      positions.push_back(atlas.positions[vertex]);
      normals.push_back(atlas.normals[vertex]);
    }
  if (positions.empty()) return 0;
  const std::vector<float> openness = surface_openness(atlas, {positions, normals});
  double length = 0;
  for (const SeamEdge& edge : seams)
    length += edge.length * 0.5 *
              (static_cast<double>(openness[index[edge.from]]) + static_cast<double>(openness[index[edge.to]]));
  return length;
}

/// Sums each chart's areas and texels, and derives the whole atlas's measures.
void measure_scales(const TriangleMesh& atlas, const std::vector<std::uint32_t>& chart_of, int width, int height,
                    AtlasMeasures& measures) {
  const Eigen::Vector2d size(width, height);
  std::vector<double> areas(static_cast<std::size_t>(measures.charts)), texels(areas.size());
  const auto corners_of = [&](const Triangle& t) {
    std::array<Eigen::Vector3d, 3> corners;
    for (int k = 0; k < 3; ++k) corners[k] = atlas.positions[t[k]].cast<double>();
    return corners;
  };
  for (std::size_t i = 0; i < atlas.triangles.size(); ++i) {
    if (chart_of[i] == no_index) continue;
    const auto [a, b, c] = corners_of(atlas.triangles[i]);
    areas[chart_of[i]] += 0.5 * (b - a).cross(c - a).norm();
    texels[chart_of[i]] += std::abs(uv_area(atlas, atlas.triangles[i])) * size.prod();
  }

  StretchSum stretch;
  for (std::size_t i = 0; i < atlas.triangles.size(); ++i) {
    if (chart_of[i] == no_index || !(areas[chart_of[i]] > 0)) continue;
    const double scale = std::sqrt(areas[chart_of[i]] / texels[chart_of[i]]);  // object units per texel
    std::array<Eigen::Vector2d, 3> uvs;
    for (int k = 0; k < 3; ++k) uvs[k] = atlas.uvs[atlas.triangles[i][k]].cast<double>().cwiseProduct(size) * scale;
    stretch.add(corners_of(atlas.triangles[i]), uvs);
  }
  measures.stretch = stretch.result();

  for (std::size_t chart = 0; chart < areas.size(); ++chart) {
    if (!(areas[chart] > 0)) continue;
    const double density = std::sqrt(texels[chart] / areas[chart]);
    measures.density_max = std::max(measures.density_max, density);
    measures.density_min = measures.density_min == 0 ? density : std::min(measures.density_min, density);
  }
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  if (!(area > 0)) return;
  measures.texels_per_unit = std::sqrt(std::accumulate(texels.begin(), texels.end(), 0.0) / area);
  const std::vector<SeamEdge> seams = seam_edges(atlas);
  for (const SeamEdge& edge : seams) measures.seam_length += edge.length;
  measures.seam_length_relative = measures.seam_length / std::sqrt(area);
  measures.visible_seam_length_relative = visible_length(atlas, seams) / std::sqrt(area);
}

/// Finds triangles and charts without a texel.
void measure_coverage(const TriangleMesh& atlas, const std::vector<std::uint32_t>& chart_of, const UvRaster& raster,
                      AtlasMeasures& measures) {
  constexpr std::size_t most_listed = 100;
  std::vector<std::uint8_t> covers(atlas.triangles.size()), chart_covers(static_cast<std::size_t>(measures.charts));
  for (const TexelSource& texel : raster.texels)
    if (texel.covered()) covers[texel.triangle] = 1;
  for (std::size_t i = 0; i < atlas.triangles.size(); ++i) {
    if (covers[i] != 0) {
      chart_covers[chart_of[i]] = 1;
      continue;
    }
    ++measures.uncovered_triangles;
    if (measures.uncovered.size() < most_listed)
      measures.uncovered.push_back({static_cast<std::uint32_t>(i), chart_of[i] == no_index});
  }
  measures.uncovered_charts = static_cast<int>(std::count(chart_covers.begin(), chart_covers.end(), 0));
}

}  // namespace

std::vector<std::uint32_t> charts_of_triangles(const TriangleMesh& atlas) {
  std::vector<std::uint32_t> parent = first_at_position_and_uv(atlas);
  const auto find = [&](std::uint32_t v) {
    while (parent[v] != v) v = parent[v] = parent[parent[v]];
    return v;
  };
  for (const Triangle& t : atlas.triangles) {
    if (uv_area(atlas, t) == 0) continue;
    for (int k = 1; k < 3; ++k) {
      const std::uint32_t a = find(t[0]), b = find(t[k]);
      parent[std::max(a, b)] = std::min(a, b);
    }
  }
  std::vector<std::uint32_t> number(atlas.positions.size(), no_index), result(atlas.triangles.size(), no_index);
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < atlas.triangles.size(); ++i) {
    if (uv_area(atlas, atlas.triangles[i]) == 0) continue;
    std::uint32_t& chart = number[find(atlas.triangles[i][0])];
    if (chart == no_index) chart = count++;
    result[i] = chart;
  }
  return result;
}

int smallest_gap(const UvRaster& raster, const std::vector<std::uint32_t>& chart_of) {
  const int width = raster.width, height = raster.height;
  const auto chart_at = [&](int i, int j) {
    const TexelSource& texel = raster.at(i, j);
    return texel.covered() ? chart_of[texel.triangle] : no_index;
  };
  int gap = std::max(width, height);
  for (int j = 0; j < height; ++j)
    for (int i = 0; i < width; ++i)
      if (raster.at(i, j).covered()) gap = std::min({gap, i, j, width - 1 - i, height - 1 - j});

  // Search around every texel on a chart's outline, in growing windows, until another chart is met.
  for (int reach = 8;; reach *= 2) {
    const int window = std::min(reach, gap);  // a chart at Chebyshev distance d leaves a gap of d - 1
    int least = gap;
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i) {
        const std::uint32_t chart = chart_at(i, j);
        if (chart == no_index) continue;
        const bool inside = i > 0 && i + 1 < width && j > 0 && j + 1 < height && chart_at(i - 1, j) == chart &&
                            chart_at(i + 1, j) == chart && chart_at(i, j - 1) == chart && chart_at(i, j + 1) == chart;
        if (inside) continue;
        // Half the window is enough: the other texel looks back.
        for (int y = j; y <= std::min(height - 1, j + window); ++y)
          for (int x = std::max(0, i - window); x <= std::min(width - 1, i + window); ++x) {
            const std::uint32_t other = chart_at(x, y);
            if (other != no_index && other != chart) least = std::min(least, std::max(std::abs(x - i), y - j) - 1);
          }
      }
    if (least < gap || window == gap) return least;
  }
}

AtlasMeasures measure_atlas(const TriangleMesh& atlas, int width, int height) {
  AtlasMeasures measures;
  const std::vector<std::uint32_t> chart_of = charts_of_triangles(atlas);
  for (const std::uint32_t chart : chart_of)
    if (chart != no_index) measures.charts = std::max(measures.charts, static_cast<int>(chart) + 1);
  measures.triangles = static_cast<int>(atlas.triangles.size());
  measures.vertices = static_cast<int>(atlas.positions.size());

  const UvRaster raster = rasterise_uvs(atlas, width, height);
  measures.covered_texels = raster.covered_texels;
  measures.overlapping_texels = raster.overlapping_texels;
  measures.utilisation = static_cast<double>(raster.covered_texels) / (static_cast<double>(width) * height);
  measures.smallest_gap_texels = smallest_gap(raster, chart_of);

  for (const Triangle& t : atlas.triangles) measures.flipped_triangles += uv_area(atlas, t) < 0;
  measure_coverage(atlas, chart_of, raster, measures);
  measure_scales(atlas, chart_of, width, height, measures);
  return measures;
}

Json AtlasMeasures::to_json() const {
  Json listed = Json::array();
  for (const Uncovered& entry : uncovered)
    listed.push_back(
        {{"triangle", entry.triangle}, {"why", entry.without_area ? "no area" : "smaller or thinner than a texel"}});
  return {{"charts", charts},
          {"triangles", triangles},
          {"vertices", vertices},
          {"covered_texels", covered_texels},
          {"utilisation", utilisation},
          {"stretch_l2", stretch.l2},
          {"stretch_linf", stretch.linf},
          {"texels_per_unit", texels_per_unit},
          {"density_min", density_min},
          {"density_max", density_max},
          {"seam_length", seam_length},
          {"seam_length_relative", seam_length_relative},
          {"visible_seam_length_relative", visible_seam_length_relative},
          {"overlapping_texels", overlapping_texels},
          {"flipped_triangles", flipped_triangles},
          {"smallest_gap_texels", smallest_gap_texels},
          {"uncovered_triangles", uncovered_triangles},
          {"uncovered_charts", uncovered_charts},
          {"uncovered", listed}};
}

}  // namespace kiln
