#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <algorithm>

namespace kiln {

/// Positions in the file are rounded by half of 1/65,535 of the box's longest side in each axis, in the worst case
/// sqrt(3) / 2 of that in one direction. A triangle whose heights are this many steps keeps its winding whatever is
/// rounded.
constexpr double smallest_height_steps = 4;

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

/// What triangles may not go below.
struct ShapeLimits {
  double slenderness = 0;  ///< height over longest edge
  double height = 0;       ///< below, a triangle is too thin to have a shape (thinnest_heights)
};

/// Whether `triangle` is too thin to say where it faces.
inline bool is_thin(const TriangleShape& triangle, const ShapeLimits& limits) {
  return triangle.squared_height < limits.height * limits.height;
}

/// Whether a triangle may change so: it does not turn over, nor become thin or more slender than the limits. One that
/// was more slender from the start, as the rims of thin walls are, may get longer, but not lower. What was thin, such
/// as the needles and caps that CSG leaves on edges, may change in any way, so that it can go, but when it becomes wide
/// again, it faces as what is `around` it: a sum of normals, asked for only then.
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
