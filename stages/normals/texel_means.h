// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <functional>
#include <vector>

#include "image/image.h"
#include "mesh/surface_point.h"
#include "normals/point_matcher.h"
#include "normals/texel_match.h"

namespace kiln {

/// Points of the high mesh under several samples of each texel, for maps that are means of what its materials say.
class TexelMeans {
 public:
  /// Finds the samples' points, four of each texel up to a map of 2048 x 2048, one beyond. `raster` is that of the
  /// matcher's atlas, and `position` has the points of its covered texels (match_texels).
  TexelMeans(const HighSurface& high, const PointMatcher& matcher, const UvRaster& raster,
             const Image<float>& position);

  /// Returns the mean of a value over each texel's samples, of 1 or 3 channels; 0 where there are none.
  Image<float> of(int channels, const std::function<Eigen::Vector3f(const SurfacePoint&)>& value) const;

  /// Returns 1 per texel that has samples, else 0.
  const std::vector<std::uint8_t>& known() const { return known_; }

 private:
  int width_, height_, side_;
  std::vector<SurfacePoint> points_;  // by sample; rows from the bottom
  std::vector<std::uint8_t> known_;
};

}  // namespace kiln
