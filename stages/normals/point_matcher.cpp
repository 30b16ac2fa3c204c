// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/point_matcher.h"

#include <Eigen/Geometry>
#include <algorithm>

namespace kiln {

namespace {

Eigen::Vector3f between(const std::array<Eigen::Vector3f, 3>& corners, const TexelSource& source) {
  return corners[0] + source.u * (corners[1] - corners[0]) + source.v * (corners[2] - corners[0]);
}

}  // namespace

bool PointMatcher::leaves(const std::array<Eigen::Vector3f, 3>& offsets) const {
  const float least = surface_tolerance();
  return std::any_of(offsets.begin(), offsets.end(), [&](const auto& offset) { return offset.norm() > least; });
}

std::array<Eigen::Vector3f, 3> PointMatcher::lines(std::uint32_t triangle) const {
  const Triangle& t = atlas_.triangles[triangle];
  if (plan_.cage.empty() || !leaves(plan_.cage[triangle]))
    return {atlas_.normals[t[0]], atlas_.normals[t[1]], atlas_.normals[t[2]]};
  std::array<Eigen::Vector3f, 3> offsets = plan_.cage[triangle];
  float longest = 0;
  for (const Eigen::Vector3f& offset : offsets) longest = std::max(longest, offset.norm());
  for (Eigen::Vector3f& offset : offsets) offset /= longest;
  return offsets;
}

Eigen::Vector3f PointMatcher::line(const TexelSource& source) const {
  const Eigen::Vector3f normal = interpolate(atlas_, atlas_.normals, source).normalized();
  if (plan_.cage.empty()) return normal;
  const Eigen::Vector3f offset = between(plan_.cage[source.triangle], source);
  return offset.norm() > surface_tolerance() ? Eigen::Vector3f(offset.normalized()) : normal;
}

SurfaceMatch PointMatcher::match(const Eigen::Vector3f& low_point, const Eigen::Vector3f& direction,
                                 const TexelSource& source) const {
  const std::uint32_t part = plan_.part_of_low(source.triangle);
  if (plan_.cage.empty()) return match_surface(high_, parts_.scene(part), low_point, direction, limits_[part]);
  const Eigen::Vector3f normal = interpolate(atlas_, atlas_.normals, source).normalized();
  return match_through_cage(high_, parts_.scene(part), low_point, between(plan_.cage[source.triangle], source), normal,
                            limits_[part].surface_tolerance);
}

}  // namespace kiln
