// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Point on a surface: a triangle, and the place in it.
struct SurfacePoint {
  static constexpr std::uint32_t none = ~0u;
  std::uint32_t triangle = none;  ///< `none`: nothing was hit or found
  float u = 0;                    ///< weight of the triangle's second corner
  float v = 0;                    ///< weight of the third
  float distance = 0;             ///< distance from the query, in object units

  bool found() const { return triangle != none; }
};

/// Returns the unit normal of a triangle, by its winding.
Eigen::Vector3f face_normal(const TriangleMesh& mesh, std::uint32_t triangle);

/// Weighs the values of a triangle's corners, value_at(0) to value_at(2), at a place in it: anything with the weights u
/// and v of its second and third corner.
template <class Value, class Place, class ValueAt>
Value weigh_corners(const Place& place, const ValueAt& value_at) {
  return (1 - place.u - place.v) * value_at(0) + place.u * value_at(1) + place.v * value_at(2);
}

/// Interpolates an attribute of vertices linearly at a place of a mesh: a SurfacePoint, or the source of a texel.
template <class Value, class Place>
Value interpolate(const TriangleMesh& mesh, const std::vector<Value>& attribute, const Place& place) {
  const Triangle& t = mesh.triangles[place.triangle];
  return weigh_corners<Value>(place, [&](std::size_t k) -> const Value& { return attribute[t[k]]; });
}

/// Returns the position of a point of a mesh.
Eigen::Vector3f position_at(const TriangleMesh& mesh, const SurfacePoint& point);

/// Returns the unit normal at a point of a mesh with normals, interpolated between the triangle's corners; the
/// triangle's own normal where these cancel.
Eigen::Vector3f normal_at(const TriangleMesh& mesh, const SurfacePoint& point);

}  // namespace kiln
