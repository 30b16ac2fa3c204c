#include "atlas/measure.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "atlas/surface.h"
#include "mesh/uv_raster.h"

namespace kiln {

namespace {

double uv_area(const TriangleMesh& atlas, const Triangle& t) {
  return 0.5 * cross(atlas.uvs[t[0]].cast<double>(), atlas.uvs[t[1]].cast<double>(), atlas.uvs[t[2]].cast<double>());
}

/// For each vertex, the first one at the very same place.
std::vector<std::uint32_t> welded(const std::vector<Eigen::Vector3f>& positions) {
  std::vector<std::uint32_t> order(positions.size()), result(positions.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto key = [&](std::uint32_t v) {
    return std::make_tuple(positions[v].x(), positions[v].y(), positions[v].z());
  };
  std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  for (std::size_t i = 0; i < order.size(); ++i)
    result[order[i]] = i > 0 && key(order[i]) == key(order[i - 1]) ? result[order[i - 1]] : order[i];
  return result;
}

double measure_seams(const TriangleMesh& atlas) {
  const std::vector<std::uint32_t> weld = welded(atlas.positions);
  struct Edge {
    std::uint32_t low, high;                // welded vertices
    std::uint32_t low_vertex, high_vertex;  // of the atlas
  };
  std::vector<Edge> edges;
  for (const Triangle& t : atlas.triangles) {
    if (uv_area(atlas, t) == 0) continue;
    for (int k = 0; k < 3; ++k) {
      std::uint32_t a = t[k], b = t[(k + 1) % 3];
      if (weld[a] > weld[b]) std::swap(a, b);
      edges.push_back({weld[a], weld[b], a, b});
    }
  }
  const auto key = [](const Edge& e) { return std::tie(e.low, e.high, e.low_vertex, e.high_vertex); };
  std::sort(edges.begin(), edges.end(), [&](const Edge& a, const Edge& b) { return key(a) < key(b); });
  double length = 0;
  for (std::size_t i = 1; i < edges.size(); ++i) {
    const Edge &a = edges[i - 1], &b = edges[i];
    if (a.low != b.low || a.high != b.high || key(a) == key(b)) continue;
    length += static_cast<double>((atlas.positions[a.low_vertex] - atlas.positions[a.high_vertex]).norm());
  }
  return length;
}

/// Looks around every covered texel that has an uncovered neighbour, in growing windows, until something is met.
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

}  // namespace

std::vector<std::uint32_t> charts_of_triangles(const TriangleMesh& atlas) {
  std::vector<std::uint32_t> parent(atlas.positions.size());
  std::iota(parent.begin(), parent.end(), 0u);
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

  TriangleMesh texels = atlas;  // with uvs in texels: stretch and scale need square ones
  double uv_sum = 0, area = 0;
  for (Eigen::Vector2f& uv : texels.uvs)
    uv = uv.cwiseProduct(Eigen::Vector2f(static_cast<float>(width), static_cast<float>(height)));
  for (const Triangle& t : texels.triangles) {
    const double triangle_area = uv_area(texels, t);
    if (triangle_area == 0) continue;
    if (triangle_area < 0) ++measures.flipped_triangles;
    uv_sum += triangle_area;
    const Eigen::Vector3d a = atlas.positions[t[0]].cast<double>(), b = atlas.positions[t[1]].cast<double>(),
                          c = atlas.positions[t[2]].cast<double>();
    area += 0.5 * (b - a).cross(c - a).norm();
  }
  measures.stretch = measure_stretch(texels);
  measures.texels_per_unit = area > 0 ? std::sqrt(uv_sum / area) : 0;
  measures.seam_length = measure_seams(atlas);
  measures.seam_length_relative = area > 0 ? measures.seam_length / std::sqrt(area) : 0;
  return measures;
}

Json AtlasMeasures::to_json() const {
  return {{"charts", charts},
          {"triangles", triangles},
          {"vertices", vertices},
          {"covered_texels", covered_texels},
          {"utilisation", utilisation},
          {"stretch_l2", stretch.l2},
          {"stretch_linf", stretch.linf},
          {"texels_per_unit", texels_per_unit},
          {"seam_length", seam_length},
          {"seam_length_relative", seam_length_relative},
          {"overlapping_texels", overlapping_texels},
          {"flipped_triangles", flipped_triangles},
          {"smallest_gap_texels", smallest_gap_texels}};
}

}  // namespace kiln
