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
  /// Matches the samples, four of each texel up to a map of 1024 x 1024, one beyond. Throws WrongUsage where the atlas
  /// covers no texel of that size.
  TexelMeans(const HighSurface& high, const PointMatcher& matcher, int width, int height);

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
