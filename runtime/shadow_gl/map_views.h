// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>

#include "mesh/placement.h"
#include "runtime/shadow/placed_nodes.h"

namespace kiln {

/// What a visibility map sees: a pyramid from a point along `axis`. Columns of the scene's space, unit vectors.
struct MapView {
  Eigen::Vector3d right = Eigen::Vector3d::UnitX(), up = Eigen::Vector3d::UnitY(), axis = Eigen::Vector3d::UnitZ();
  double half_width = 1;  ///< at distance 1

  /// Tests whether anything of a ball, whose centre is relative to the point, may be in the pyramid.
  bool may_see(const BoundingBall& ball) const;
};

/// Cones of light up to this half-angle (radians) are seen by one map, others by those of a cube.
inline constexpr double widest_map = 0.7853981633974483;

/// Returns the view around a cone of light, of at most widest_map; a single direction is in the middle of a narrow one.
/// Its axes are those that turn +Z to the cone's axis the shortest way, as for cone_directions.
MapView view_of_cone(const Eigen::Vector3d& axis, double half_angle);

/// Returns the view of a face of the cube around a point: 0 to 5 for +X, -X, +Y, -Y, +Z, -Z.
MapView view_of_face(int face);

/// From an object's space to that of a map: rows, of which the first two count in half-widths at distance 1.
using MapRows = Eigen::Matrix<float, 3, 4, Eigen::RowMajor>;

/// Returns the rows of a node for the map at a point of the scene. The difference of places is taken in float64.
MapRows rows_of(const MapView& view, const Placement& node, const Eigen::Vector3d& point);

}  // namespace kiln
