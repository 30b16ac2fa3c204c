// SPDX-License-Identifier: MIT
#include "sh/ray_offset.h"

#include <algorithm>
#include <limits>

namespace kiln {

float rounding_offset(std::span<const Eigen::Vector3f> positions) {
  constexpr float roundings = 16;
  constexpr float rounding = std::numeric_limits<float>::epsilon() / 2;  // of a number, relative
  float largest = 0;
  for (const Eigen::Vector3f& position : positions) largest = std::max(largest, position.cwiseAbs().maxCoeff());
  return roundings * rounding * largest;
}

}  // namespace kiln
