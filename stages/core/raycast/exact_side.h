// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace kiln {

/// Share of a mesh's diagonal below which is_before decides hits: up to this distance, in float32, a grazing ray that
/// starts on a sliver of the surface may seem to hit that surface.
inline constexpr float doubtful_share = 0.01f;

/// Tests in float64 whether the plane of a triangle lies in front of a ray's origin, not behind it. Intersection in
/// float32 is off by the rounding of coordinates times the triangle's length over its height, so that a point of a
/// sliver may seem to lie behind the sliver. False for triangles without area.
inline bool is_before(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, const Eigen::Vector3f& a,
                      const Eigen::Vector3f& b, const Eigen::Vector3f& c) {
  const Eigen::Vector3d first = a.cast<double>();
  const Eigen::Vector3d normal = (b.cast<double>() - first).cross(c.cast<double>() - first);
  return normal.dot(first - origin.cast<double>()) * normal.dot(direction.cast<double>()) > 0;
}

}  // namespace kiln
