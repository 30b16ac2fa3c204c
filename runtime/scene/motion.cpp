// SPDX-License-Identifier: MIT
#include "runtime/scene/motion.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "runtime/scene/track.h"

namespace kiln {

double time_within(double time, double first, double last, MotionEnds ends) {
  const double span = last - first;
  if (ends == MotionEnds::hold || !(span > 0)) return std::clamp(time, first, last);
  const double rounds = (time - first) / span, round = std::floor(rounds);
  const double part = std::clamp(time - first - round * span, 0.0, span);
  const bool is_back = ends == MotionEnds::mirror && std::fmod(round, 2) != 0;
  return is_back ? last - part : first + part;
}

Eigen::Vector3d circle_offset(const CircularOrbit& orbit, double time) {
  Eigen::Vector3d from = Eigen::Vector3d::UnitZ() - orbit.axis.z() * orbit.axis;
  if (from.norm() < 1e-6) from = Eigen::Vector3d::UnitX() - orbit.axis.x() * orbit.axis;
  from.normalize();
  const double angle = orbit.angle_degrees(time) * std::numbers::pi / 180;
  return orbit.radius * (std::cos(angle) * from + std::sin(angle) * orbit.axis.cross(from));
}

Placement place_at(const Placement& rest, const Motion& motion, double time) {
  Placement place = rest;
  if (const auto* keyframes = std::get_if<Keyframes>(&motion)) {
    const std::vector<Keyframe>& frames = keyframes->frames;
    const double now = time_within(time, frames.front().time, frames.back().time, keyframes->ends);
    const auto linear = [](const auto& a, const auto& b, double share) { return ((1 - share) * a + share * b).eval(); };
    if (const auto at = track_at(frames, &Keyframe::translation, now, linear)) place.translation = *at;
    const auto slerp = [](const Eigen::Quaterniond& a, const Eigen::Quaterniond& b, double share) {
      return a.slerp(share, b);
    };
    if (const auto at = track_at(frames, &Keyframe::rotation, now, slerp)) place.rotation = at->toRotationMatrix();
    const auto between = [](double a, double b, double share) { return std::lerp(a, b, share); };
    if (const auto at = track_at(frames, &Keyframe::scale, now, between)) place.scale = *at;
  } else if (const auto* orbit = std::get_if<CircularOrbit>(&motion)) {
    place.translation += circle_offset(*orbit, time);
    if (orbit->turns)
      place.rotation =
          Eigen::AngleAxisd(orbit->angle_degrees(time) * std::numbers::pi / 180, orbit->axis) * place.rotation;
  }
  return place;
}

double duration_of(const Motion& motion) {
  if (const auto* keyframes = std::get_if<Keyframes>(&motion)) return std::max(0.0, keyframes->frames.back().time);
  if (const auto* orbit = std::get_if<CircularOrbit>(&motion)) return std::abs(orbit->period);
  return 0;
}

Placement compose(const Placement& outer, const Placement& inner) {
  return {outer.rotation * inner.rotation, outer.scale * inner.scale, outer.to_scene(inner.translation)};
}

void check_motion(const Motion& motion) {
  const auto require = [](bool good, const char* message) {
    if (!good) throw WrongUsage(message);
  };
  if (const auto* keyframes = std::get_if<Keyframes>(&motion)) {
    require(!keyframes->frames.empty(), "keyframes: found none; expected at least one");
    double before = -HUGE_VAL;
    for (const Keyframe& frame : keyframes->frames) {
      require(std::isfinite(frame.time) && frame.time > before,
              "keyframes: found times that do not rise; expected the order of time");
      before = frame.time;
      require(!frame.translation || frame.translation->allFinite(), "keyframes: found a translation that is no place");
      require(!frame.rotation || std::abs(frame.rotation->norm() - 1) < 1e-6,
              "keyframes: found a quaternion of another length; expected 1");
      require(!frame.scale || (std::isfinite(*frame.scale) && *frame.scale > 0),
              "keyframes: found a scale of 0 or below; expected one above 0");
    }
  } else if (const auto* orbit = std::get_if<CircularOrbit>(&motion)) {
    require(std::abs(orbit->axis.norm() - 1) < 1e-6, "orbit: found an axis of another length; expected 1");
    require(std::isfinite(orbit->radius) && orbit->radius >= 0, "orbit: found a radius below 0; expected 0 or more");
    require(std::isfinite(orbit->period) && orbit->period != 0, "orbit: found a period of 0; expected seconds");
    require(std::isfinite(orbit->phase_degrees), "orbit: found a phase that is no number; expected degrees");
  }
}

}  // namespace kiln
