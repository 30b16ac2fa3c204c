// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/drawing.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "atlas/measure.h"
#include "atlas/surface.h"
#include "base/extent.h"
#include "mesh/uv_raster.h"

namespace kiln {

namespace {

using Color = std::array<double, 3>;

/// Returns a chart's colour. Hues are a golden section apart, so that neighbouring numbers differ most; two
/// brightnesses.
Color chart_color(std::uint32_t chart) {
  const double hue = std::fmod(0.618033988749895 * chart, 1.0) * 6;
  const double value = chart % 2 == 0 ? 235 : 185;
  Color color;
  for (int channel = 0; channel < 3; ++channel) {
    const double k = std::fmod(5.0 - 2 * channel + hue, 6.0);
    color[channel] = value * (1 - 0.55 * std::clamp(std::min(k, 4 - k), 0.0, 1.0));
  }
  return color;
}

/// Returns the distance in pixels from a point of a triangle to its nearest side.
double side_distance(const TriangleMesh& atlas, const TexelSource& source, const Eigen::Vector2d& pixels) {
  const Triangle& t = atlas.triangles[source.triangle];
  const double weights[3] = {1.0 - source.u - source.v, source.u, source.v};
  const auto point = [&](int k) { return Eigen::Vector2d(atlas.uvs[t[k]].cast<double>().cwiseProduct(pixels)); };
  const double twice_area = std::abs(cross(point(0), point(1), point(2)));
  double least = pixels.maxCoeff();
  for (int k = 0; k < 3; ++k) {
    const double side = (point((k + 2) % 3) - point((k + 1) % 3)).norm();
    if (side > 0) least = std::min(least, weights[k] * twice_area / side);
  }
  return least;
}

/// Tells per pixel whether one within `reach` pixels is covered: a square window, first along rows, then columns.
std::vector<std::uint8_t> near_covered(const UvRaster& raster, int reach) {
  std::vector<std::uint8_t> along(raster.texels.size()), result(raster.texels.size());
  for (const bool columns : {false, true}) {
    const int size = columns ? raster.height : raster.width, lines = columns ? raster.width : raster.height;
    const std::size_t stride = columns ? raster.width : 1, line_stride = columns ? 1 : raster.width;
    for (int line = 0; line < lines; ++line) {
      int last = -size - reach;
      const auto index = [&](int i) { return line * line_stride + i * stride; };
      const auto on = [&](int i) { return columns ? along[index(i)] != 0 : raster.texels[index(i)].covered(); };
      for (int i = 0; i < size + reach; ++i) {
        if (i < size && on(i)) last = i;
        const int centre = i - reach;  // centre of the window that ends at i
        if (centre >= 0) (columns ? result : along)[index(centre)] = last >= centre - reach;
      }
    }
  }
  return result;
}

}  // namespace

Image<std::uint8_t> draw_atlas(const TriangleMesh& atlas, const Extent& size, int gutter_texels) {
  const int longer = std::max(size.width, size.height);
  const int zoom = std::max(1, (1024 + longer - 1) / longer);
  const Extent pixels(size.width * zoom, size.height * zoom);
  const UvRaster raster = rasterise_uvs(atlas, pixels.width, pixels.height);
  const std::vector<std::uint32_t> chart_of = charts_of_triangles(atlas);
  const std::vector<std::uint8_t> gutter = near_covered(raster, gutter_texels * zoom);

  Image<std::uint8_t> picture(pixels.width, pixels.height, 3);
  for (int j = 0; j < pixels.height; ++j)
    for (int i = 0; i < pixels.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      Color color{30, 30, 34};
      if (source.covered()) {
        color = chart_color(chart_of[source.triangle]);
        // Edges are lines one pixel wide on each side.
        const double edge =
            std::clamp(1.5 - side_distance(atlas, source, Eigen::Vector2d(pixels.width, pixels.height)), 0.0, 1.0);
        for (double& channel : color) channel *= 1 - 0.6 * edge;
      } else if (gutter[static_cast<std::size_t>(j) * pixels.width + i]) {
        color = {82, 82, 88};
      }
      for (int channel = 0; channel < 3; ++channel)
        picture.at(i, j, channel) = static_cast<std::uint8_t>(std::lround(color[channel]));
    }
  return picture;
}

}  // namespace kiln
