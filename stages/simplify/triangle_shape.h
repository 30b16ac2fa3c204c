// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

namespace kiln {

/// Height of the thinnest triangle that a file keeps, in its steps. Positions in the file are rounded by half of
/// 1/65,535 of the box's longest side in each axis, in the worst case sqrt(3) / 2 of that in one direction. A triangle
/// whose heights are this many steps keeps its winding whatever is rounded.
constexpr double smallest_height_steps = 4;

/// Cosine of 78 degrees, by which a step of simplification may turn a triangle at most: far from folding it over, and
/// what it takes to cut a corner.
constexpr double smallest_turn_cosine = 0.2;

/// Normal and sizes of a triangle.
struct TriangleShape {
  Eigen::Vector3d normal;     ///< as long as twice the area
  double squared_edge = 0;    ///< of the longest edge
  double squared_height = 0;  ///< of the smallest height, on the longest edge

  TriangleShape(const Eigen::Vector3d& a, const Eigen::Vector3d& b, const Eigen::Vector3d& c)
      : normal((b - a).cross(c - a)),
        squared_edge(std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()})),
        squared_height(squared_edge > 0 ? normal.squaredNorm() / squared_edge : 0) {}

  double squared_slenderness() const { return squared_edge > 0 ? squared_height / squared_edge : 0; }
};

/// Limits that triangles may not go below.
struct ShapeLimits {
  double slenderness = 0;  ///< smallest height over longest edge
  double height = 0;       ///< smallest height; a triangle below is too thin to have a shape (thinnest_heights)
};

/// Tells whether `triangle` is too thin to say where it faces.
inline bool is_thin(const TriangleShape& triangle, const ShapeLimits& limits) {
  return triangle.squared_height < limits.height * limits.height;
}

/// Tells whether a triangle may change from `before` to `after`: it does not turn over, nor become thin or more slender
/// than the limits. One that was more slender from the start, as the rims of thin walls are, may get longer, but not
/// lower. What was thin, such as the needles and caps that CSG leaves on edges, may change in any way, so that it can
/// go, but when it becomes wide again, it must face as its surroundings do, whose sum of normals `around` is called for
/// only then.
template <class Around>
bool keeps_shape(const TriangleShape& before, const TriangleShape& after, const ShapeLimits& limits,
                 const Around& around) {
  if (is_thin(before, limits)) return is_thin(after, limits) || after.normal.dot(around()) > 0;
  const double cosine_part = before.normal.dot(after.normal);
  const double smallest =
      smallest_turn_cosine * smallest_turn_cosine * before.normal.squaredNorm() * after.normal.squaredNorm();
  if (!(cosine_part > 0) || cosine_part * cosine_part < smallest) return false;
  if (is_thin(after, limits)) return false;
  const double squared_limit = limits.slenderness * limits.slenderness;
  if (after.squared_slenderness() >= std::min(squared_limit, before.squared_slenderness())) return true;
  return before.squared_slenderness() < 4 * squared_limit && after.squared_height >= 0.8 * before.squared_height;
}

}  // namespace kiln
