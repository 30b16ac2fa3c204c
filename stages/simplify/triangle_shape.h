#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

namespace kiln {

/// Positions in the file are rounded by half of 1/65,535 of the box's longest side in each axis, in the worst case
/// sqrt(3) / 2 of that in one direction. A triangle whose heights are this many steps keeps its winding whatever is
/// rounded.
constexpr double smallest_height_steps = 4;
constexpr double smallest_height = smallest_height_steps / 65535;  // of the diagonal, which is longer than any side

/// A step of simplification may turn a triangle by 78 degrees at most: far from folding it over, and what it takes to
/// cut a corner.
constexpr double smallest_turn_cosine = 0.2;

/// What there is to know of a triangle's shape.
struct TriangleShape {
  Eigen::Vector3d normal;     ///< twice the area long
  double squared_edge = 0;    ///< of the longest
  double squared_height = 0;  ///< on the longest edge, the smallest

  TriangleShape(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : normal((b - a).cross(c - a)),
        squared_edge(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()})),
        squared_height(squared_edge > 0 ? normal.squaredNorm() / squared_edge : 0) {}

  double squared_slenderness() const { return squared_edge > 0 ? squared_height / squared_edge : 0; }
};

/// Whether a triangle of a frame with diagonal 1 may change so: it does not turn over, nor become thinner than 16 bits
/// can tell or than `slenderness` (height over longest edge). A scan's triangles may be thinner from the start; then it
/// is enough not to get worse.
inline bool keeps_shape(const TriangleShape& before, const TriangleShape& after, double slenderness) {
  const double cosine_part = before.normal.dot(after.normal);
  const double smallest =
      smallest_turn_cosine * smallest_turn_cosine * before.normal.squaredNorm() * after.normal.squaredNorm();
  if (!(cosine_part > 0) || cosine_part * cosine_part < smallest) return false;
  if (after.squared_height < std::min(smallest_height * smallest_height, before.squared_height)) return false;
  return after.squared_slenderness() >= std::min(slenderness * slenderness, before.squared_slenderness());
}

}  // namespace kiln
