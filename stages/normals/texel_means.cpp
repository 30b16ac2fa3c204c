// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/texel_means.h"

#include <limits>
#include <string>

#include "base/errors.h"
#include "base/parallel.h"

namespace kiln {

namespace {

constexpr std::int64_t most_supersampled_texels = std::int64_t{1024} * 1024;

}  // namespace

TexelMeans::TexelMeans(const HighSurface& high, const PointMatcher& matcher, int width, int height)
    : width_(width), height_(height), side_(std::int64_t{width} * height <= most_supersampled_texels ? 2 : 1) {
  const UvRaster raster = rasterise_uvs(matcher.atlas(), side_ * width, side_ * height);
  if (raster.covered_texels == 0)
    throw WrongUsage("the atlas covers no texel of a map of " + std::to_string(width) + " x " + std::to_string(height) +
                     "; give a larger one");
  const SurfaceAlbedo none;
  const TexelMatches matches = match_texels({high.mesh, high.parts, none}, matcher, raster, 1, false, no_progress);
  points_.resize(raster.texels.size());
  known_.assign(static_cast<std::size_t>(width) * static_cast<std::size_t>(height), 0);
  parallel_for(0, raster.height, [&](int j) {
    for (int i = 0; i < raster.width; ++i) {
      if (!raster.at(i, j).covered()) continue;
      const Eigen::Vector3f position(matches.position.pixel(i, j).data());
      points_[static_cast<std::size_t>(j) * static_cast<std::size_t>(raster.width) + static_cast<std::size_t>(i)] =
          high.parts.scene(matcher.plan().part_of_low(raster.at(i, j).triangle))
              .closest_point(position, std::numeric_limits<float>::infinity());
    }
  });
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i)
      if (raster.at(i, j).covered())
        known_[static_cast<std::size_t>(j / side_) * static_cast<std::size_t>(width) +
               static_cast<std::size_t>(i / side_)] = 1;
}

Image<float> TexelMeans::of(int channels, const std::function<Eigen::Vector3f(const SurfacePoint&)>& value) const {
  Image<float> map(width_, height_, channels);
  const std::size_t row = static_cast<std::size_t>(side_) * static_cast<std::size_t>(width_);
  parallel_for(0, height_, [&](int j) {
    for (int i = 0; i < width_; ++i) {
      Eigen::Vector3f sum = Eigen::Vector3f::Zero();
      int count = 0;
      for (int y = side_ * j; y < side_ * (j + 1); ++y)
        for (int x = side_ * i; x < side_ * (i + 1); ++x) {
          const SurfacePoint& point = points_[static_cast<std::size_t>(y) * row + static_cast<std::size_t>(x)];
          if (!point.found()) continue;
          sum += value(point);
          ++count;
        }
      for (int c = 0; c < channels && count > 0; ++c) map.at(i, j, c) = sum[c] / static_cast<float>(count);
    }
  });
  return map;
}

}  // namespace kiln
