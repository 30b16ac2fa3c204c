// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/texel_means.h"

#include <limits>

#include "base/parallel.h"

namespace kiln {

namespace {

constexpr std::int64_t most_supersampled_texels = std::int64_t{2048} * 2048;

}  // namespace

TexelMeans::TexelMeans(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster,
                       const Image<float>& position)
    : width_(raster.width),
      height_(raster.height),
      side_(std::int64_t{raster.width} * raster.height <= most_supersampled_texels ? 2 : 1) {
  const TriangleMesh& atlas = matcher.atlas();
  const UvRaster fine = rasterise_uvs(atlas, side_ * width_, side_ * height_);
  points_.resize(fine.texels.size());
  known_.assign(raster.texels.size(), 0);
  parallel_for(0, height_, [&](int j) {
    for (int i = 0; i < width_; ++i) {
      const TexelSource& centre = raster.at(i, j);
      std::uint8_t& known =
          known_[static_cast<std::size_t>(j) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(i)];
      const auto point_at = [&](int x, int y) -> SurfacePoint& {
        return points_[static_cast<std::size_t>(y) * static_cast<std::size_t>(fine.width) +
                       static_cast<std::size_t>(x)];
      };
      const auto nearest = [&](const Eigen::Vector3f& place, const TexelSource& source) {
        return high.parts.scene(matcher.plan().part_of_low(source.triangle))
            .closest_point(place, std::numeric_limits<float>::infinity());
      };
      const Eigen::Vector3f centre_point(position.pixel(i, j).data());
      for (int y = side_ * j; y < side_ * (j + 1); ++y)
        for (int x = side_ * i; x < side_ * (i + 1); ++x) {
          const TexelSource& sample = fine.at(x, y);
          if (!sample.covered()) continue;
          known = 1;
          const Eigen::Vector3f low = interpolate(atlas, atlas.positions, sample);
          // As far from the centre's point as the low mesh's points are from each other.
          point_at(x, y) = centre.covered()
                               ? nearest(centre_point + low - interpolate(atlas, atlas.positions, centre), sample)
                               : matcher.match(low, matcher.line(sample), sample).point;
        }
      if (known != 0 || !centre.covered()) continue;
      known = 1;  // a triangle so thin that it passes between the samples
      point_at(side_ * i, side_ * j) = nearest(centre_point, centre);
    }
  });
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
