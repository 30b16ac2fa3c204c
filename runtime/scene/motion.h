// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <optional>
#include <variant>
#include <vector>

#include "mesh/placement.h"

namespace kiln {

/// Moment of a motion. What it leaves out is interpolated between the moments that say it.
struct Keyframe {
  double time = 0;  ///< seconds
  std::optional<Eigen::Vector3d> translation;
  std::optional<Eigen::Quaterniond> rotation;  ///< unit
  std::optional<double> scale;                 ///< above 0
};

/// What a motion by keyframes does before its first and after its last.
enum class MotionEnds {
  hold,    ///< stays as at that keyframe
  repeat,  ///< begins anew
  mirror,  ///< goes back and forth
};

/// Places at some times. Translation and scale are interpolated linearly, rotation along the shorter arc at an even
/// speed (slerp), so that a turn between neighbouring keyframes is below 180 degrees.
struct Keyframes {
  std::vector<Keyframe> frames;  ///< at least one, in the order of time
  MotionEnds ends = MotionEnds::hold;
};

/// A circle around the place that a node or a light would have at rest, at an even speed. It begins towards +Z as far
/// as that is across the axis (+X for an axis along Z), and goes by the right-hand rule: about +Y from +Z to +X, as
/// azimuths do.
struct CircularOrbit {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitY();  ///< unit
  double radius = 1;                                ///< 0 or more, in the units of the parent
  double period = 1;                                ///< seconds, not 0; below 0: the other way
  double phase_degrees = 0;                         ///< at time 0
  bool turns = false;                               ///< whether what goes round also turns about the axis, as one piece

  double angle_degrees(double time) const { return phase_degrees + 360 * time / period; }
};

/// Motion of a node within its parent.
using Motion = std::variant<std::monostate, Keyframes, CircularOrbit>;

/// Returns the place within its parent that something has at a time, where `rest` is the place without a motion.
/// Keyframes replace what they say of it; a circle is around it.
Placement place_at(const Placement& rest, const Motion& motion, double time);

/// Returns the seconds after which a motion ends or begins anew; 0 for none.
double duration_of(const Motion& motion);

/// Maps a time to one within the keyframes' first and last.
double time_within(double time, double first, double last, MotionEnds ends);

/// Returns the offset from the middle of a circle.
Eigen::Vector3d circle_offset(const CircularOrbit& orbit, double time);

/// Places `inner` in the space of `outer`.
Placement compose(const Placement& outer, const Placement& inner);

/// Throws WrongUsage for a motion whose numbers are not as its members say.
void check_motion(const Motion& motion);

}  // namespace kiln
