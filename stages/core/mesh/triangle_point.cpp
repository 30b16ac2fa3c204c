// SPDX-License-Identifier: MIT
#include "mesh/triangle_point.h"

namespace kiln {

Eigen::Vector2d closest_weights(const Eigen::Vector3d& point, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                const Eigen::Vector3d& c) {
  const Eigen::Vector3d ab = b - a, ac = c - a, ap = point - a, bp = point - b, cp = point - c;
  const double d1 = ab.dot(ap), d2 = ac.dot(ap), d3 = ab.dot(bp), d4 = ac.dot(bp), d5 = ab.dot(cp), d6 = ac.dot(cp);
  if (d1 <= 0 && d2 <= 0) return {0, 0};
  if (d3 >= 0 && d4 <= d3) return {1, 0};
  if (d6 >= 0 && d5 <= d6) return {0, 1};
  const double at_c = d1 * d4 - d3 * d2, at_b = d5 * d2 - d1 * d6, at_a = d3 * d6 - d5 * d4;
  if (at_c <= 0 && d1 >= 0 && d3 <= 0) return {d1 / (d1 - d3), 0};
  if (at_b <= 0 && d2 >= 0 && d6 <= 0) return {0, d2 / (d2 - d6)};
  if (at_a <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
    const double along = (d4 - d3) / ((d4 - d3) + (d5 - d6));
    return {1 - along, along};
  }
  return Eigen::Vector2d(at_b, at_c) / (at_a + at_b + at_c);
}

}  // namespace kiln
