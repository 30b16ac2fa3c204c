// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/integrate/unoccluded.h"

#include <algorithm>
#include <limits>

#include "base/parallel.h"

namespace kiln {

std::vector<std::uint8_t> unoccluded_receivers(std::span<const Eigen::Vector3f> hull_corners,
                                               const Receivers& receivers, float lift) {
  std::vector<float> x, y, z;
  float largest = 0;
  for (const Eigen::Vector3f& corner : hull_corners) {
    x.push_back(corner.x());
    y.push_back(corner.y());
    z.push_back(corner.z());
    largest = std::max(largest, corner.cwiseAbs().maxCoeff());
  }
  std::vector<std::uint8_t> free(receivers.size());
  parallel_for(std::size_t{0}, receivers.size(), 256, [&](std::size_t r) {
    const Eigen::Vector3f& normal = receivers.normals[r];
    const Eigen::Vector3f origin = receivers.positions[r] + lift * normal;
    // Bound the dot products' roundings: three products and two sums of numbers up to `largest`.
    const float rounding = 8 * std::numeric_limits<float>::epsilon() * std::max(largest, origin.cwiseAbs().maxCoeff());
    const float plane = normal.dot(origin) - rounding;
    // Take runs of 64 corners, so that the inner loop has no way out and becomes vector code.
    constexpr std::size_t run = 64;
    bool empty = true;
    for (std::size_t begin = 0; empty && begin < x.size(); begin += run) {
      const std::size_t end = std::min(x.size(), begin + run);
      int above = 0;
      for (std::size_t k = begin; k < end; ++k)
        above |= normal.x() * x[k] + normal.y() * y[k] + normal.z() * z[k] > plane ? 1 : 0;
      empty = above == 0;
    }
    free[r] = empty ? 1 : 0;
  });
  return free;
}

}  // namespace kiln
