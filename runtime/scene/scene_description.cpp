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
  for (const SceneCamera& camera : scene.cameras)
    if (const auto* keyframes = std::get_if<CameraKeyframes>(&camera.motion))
      longest = std::max(longest, keyframes->frames.back().time);
    else if (const auto* orbit = std::get_if<CameraOrbit>(&camera.motion))
      longest = std::max(longest, std::abs(orbit->period));
  return longest;
}

CameraPlace camera_at(const SceneCamera& camera, double time) {
  CameraPlace place = camera;
  if (const auto* orbit = std::get_if<CameraOrbit>(&camera.motion))
    place.azimuth_degrees = place.azimuth_degrees.value_or(0) + orbit->phase_degrees + 360 * time / orbit->period;
  const auto* keyframes = std::get_if<CameraKeyframes>(&camera.motion);
  if (keyframes == nullptr) return place;
  // Tracks of members, each between the keyframes that say it.
  struct Moment : CameraPlace {
    double time = 0;
  };
  std::vector<Moment> moments;
  for (const CameraKeyframe& frame : keyframes->frames) moments.push_back({frame.place, frame.time});
  const double now = time_within(time, moments.front().time, moments.back().time, keyframes->ends);
  const auto move = [&]<class Value>(std::optional<Value> CameraPlace::*member) {
    const auto linear = [](const Value& a, const Value& b, double share) -> Value {
      return (1 - share) * a + share * b;
    };
    if (const auto at = track_at(moments, static_cast<std::optional<Value> Moment::*>(member), now, linear))
      place.*member = at;
  };
  move(&CameraPlace::azimuth_degrees);
  move(&CameraPlace::elevation_degrees);
  move(&CameraPlace::field_of_view_degrees);
  move(&CameraPlace::distance);
  move(&CameraPlace::zoom);
  move(&CameraPlace::target);
  return place;
}

int find_camera(const SceneDescription& scene, const std::string& name) {
  if (name.empty()) return 0;
  for (std::size_t k = 0; k < scene.cameras.size(); ++k)
    if (scene.cameras[k].name == name) return static_cast<int>(k);
  return -1;
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
