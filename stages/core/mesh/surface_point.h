// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>

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

/// Returns the position of a point of a mesh.
Eigen::Vector3f position_at(const TriangleMesh& mesh, const SurfacePoint& point);

/// Returns the unit normal at a point of a mesh with normals, interpolated between the triangle's corners; the
/// triangle's own normal where these cancel.
Eigen::Vector3f normal_at(const TriangleMesh& mesh, const SurfacePoint& point);

}  // namespace kiln
