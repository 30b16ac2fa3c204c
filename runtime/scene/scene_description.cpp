// SPDX-License-Identifier: MIT
#include "runtime/scene/scene_description.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "runtime/scene/track.h"
#include "sh/directions.h"

namespace kiln {

double duration_of(const SceneDescription& scene) {
  if (scene.duration) return *scene.duration;
  double longest = 0;
  for (const SceneItem& item : scene.items) longest = std::max(longest, duration_of(item.motion));
  for (const SceneLight& light : scene.lights)
    if (const auto* keyframes = std::get_if<LightKeyframes>(&light.motion))
      longest = std::max(longest, keyframes->frames.back().time);
    else if (const auto* orbit = std::get_if<CircularOrbit>(&light.motion))
      longest = std::max(longest, std::abs(orbit->period));
  return longest;
}

LightSpec light_at(const SceneLight& light, double time) {
  LightSpec spec = light.spec;
  const bool is_ball = spec.kind == LightSpec::Kind::sphere;
  if (const auto* keyframes = std::get_if<LightKeyframes>(&light.motion)) {
    const std::vector<LightKeyframe>& frames = keyframes->frames;
    const double now = time_within(time, frames.front().time, frames.back().time, keyframes->ends);
    const auto linear = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b, double share) -> Eigen::Vector3d {
      return (1 - share) * a + share * b;
    };
    if (const auto at = track_at(frames, &LightKeyframe::place, now, linear)) {
      if (is_ball) spec.position = {at->x(), at->y(), at->z()};
      if (!is_ball) spec.azimuth_degrees = at->x(), spec.elevation_degrees = at->y();
    }
    const auto mixed = [](const std::array<float, 3>& a, const std::array<float, 3>& b, double share) {
      const auto t = static_cast<float>(share);
      return std::array<float, 3>{std::lerp(a[0], b[0], t), std::lerp(a[1], b[1], t), std::lerp(a[2], b[2], t)};
    };
    if (const auto at = track_at(frames, &LightKeyframe::radiance, now, mixed)) spec.color = *at;
  } else if (const auto* orbit = std::get_if<CircularOrbit>(&light.motion)) {
    if (is_ball) {
      const Eigen::Vector3d at = Eigen::Vector3d(spec.position.data()) + circle_offset(*orbit, time);
      spec.position = {at.x(), at.y(), at.z()};
    } else {
      const Eigen::Vector3d rest = direction_from_angles(spec.azimuth_degrees, spec.elevation_degrees).cast<double>();
      const Eigen::Vector3d at =
          Eigen::AngleAxisd(orbit->angle_degrees(time) * std::numbers::pi / 180, orbit->axis) * rest;
      spec.azimuth_degrees = std::atan2(at.x(), at.z()) * 180 / std::numbers::pi;
      spec.elevation_degrees = std::asin(std::clamp(at.y(), -1.0, 1.0)) * 180 / std::numbers::pi;
    }
  }
  return spec;
}

}  // namespace kiln
