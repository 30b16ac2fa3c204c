// SPDX-License-Identifier: GPL-3.0-or-later
#include "lod/measure.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include "mesh/surface_point.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_texel = ~0u;

/// Returns for every texel the covered one that is nearest, by steps to the eight neighbours.
std::vector<std::uint32_t> nearest_covered(const UvRaster& raster) {
  std::vector<std::uint32_t> nearest(raster.texels.size(), no_texel), front;
  for (std::uint32_t texel = 0; texel < nearest.size(); ++texel)
    if (raster.texels[texel].covered()) {
      nearest[texel] = texel;
      front.push_back(texel);
    }
  constexpr std::array<std::array<int, 2>, 8> ways = {
      {{1, 0}, {-1, 0}, {0, 1}, {0, -1}, {1, 1}, {-1, 1}, {1, -1}, {-1, -1}}};
  while (!front.empty()) {
    std::vector<std::uint32_t> next;
    for (const std::array<int, 2>& way : ways)
      for (const std::uint32_t texel : front) {
        const int i = static_cast<int>(texel) % raster.width + way[0],
                  j = static_cast<int>(texel) / raster.width + way[1];
        if (i < 0 || j < 0 || i >= raster.width || j >= raster.height) continue;
        const auto neighbour = static_cast<std::uint32_t>(j * raster.width + i);
        if (nearest[neighbour] != no_texel) continue;
        nearest[neighbour] = nearest[texel];
        next.push_back(neighbour);
      }
    front = std::move(next);
  }
  return nearest;
}

}  // namespace

TexelDisplacementMeter::TexelDisplacementMeter(const TriangleMesh& atlas, Extent size)
    : atlas_(atlas),
      size_(size),
      raster_(rasterise_uvs(atlas, size.width, size.height)),
      content_(nearest_covered(raster_)) {}

TexelDisplacement TexelDisplacementMeter::measure(const TriangleMesh& level) const {
  const UvRaster raster = rasterise_uvs(level, size_.width, size_.height);
  TexelDisplacement result;
  result.overlapping = raster.overlapping_texels;
  double sum = 0;
  for (std::size_t texel = 0; texel < raster.texels.size(); ++texel) {
    const bool was_covered = raster_.texels[texel].covered();
    if (!raster.texels[texel].covered()) {
      result.deserted += was_covered ? 1 : 0;
      continue;
    }
    result.overhanging += was_covered ? 0 : 1;
    if (content_[texel] == no_texel) continue;  // the atlas covers no texel at all
    const Eigen::Vector3f shown = interpolate(level, level.positions, raster.texels[texel]);
    const Eigen::Vector3f made = interpolate(atlas_, atlas_.positions, raster_.texels[content_[texel]]);
    const double distance = (shown.cast<double>() - made.cast<double>()).norm();
    sum += distance;
    result.largest = std::max(result.largest, distance);
    ++result.texels;
  }
  if (result.texels > 0) result.mean = sum / static_cast<double>(result.texels);
  return result;
}

double switching_distance(double error, double radius, double pixels, const ReferencePictureSize& view) {
  const double half = std::tan(view.vertical_fov_degrees * std::numbers::pi / 360);
  return radius + error * view.lines / (2 * half * pixels);
}

double length_of_pixels(double pixels, double radius, const ReferencePictureSize& view) {
  return pixels * 2 * radius / view.lines;
}

}  // namespace kiln
