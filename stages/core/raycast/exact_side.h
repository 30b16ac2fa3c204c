// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kiln {

/// Hits nearer than this share of a mesh's diagonal are looked at again by is_before: so far off may a grazing ray that
/// starts on a sliver of its surface seem to meet that surface, in float32.
inline constexpr float doubtful_share = 0.01f;

/// Whether the plane of a triangle lies before a ray's origin, not behind it: in float64, where the float32 coordinates
/// leave no doubt. Intersection in float32 is off by the rounding of coordinates times the triangle's length over its
/// height, so that a point of a sliver may seem to lie behind it. False for triangles without area.
inline bool is_before(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, const Eigen::Vector3f& a,
                      const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d first = a.cast<double>();
  const Eigen::Vector3d normal = (b.cast<double>() - first).cross(c.cast<double>() - first);
  return normal.dot(first - origin.cast<double>()) * normal.dot(direction.cast<double>()) > 0;
}

}  // namespace kiln
