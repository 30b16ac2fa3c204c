// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "mesh/triangle_mesh.h"
#include "normals/part_scene.h"

namespace kiln {

/// Way in which the point of the high mesh was found.
enum class MatchWay { ray_outwards, ray_inwards, nearest_point };

struct SurfaceMatch {
  SurfacePoint point;  ///< point of the high mesh; its distance is from the low point
  MatchWay way = MatchWay::nearest_point;
  bool agrees = true;  ///< the high surface there faces the low normal's side
};

/// Limits of the search and of what is believed; distances in object units.
struct MatchLimits {
  float cage_distance = 0;      ///< length of rays each way
  float surface_tolerance = 0;  ///< smaller distances are rounding
};

/// Finds the point of the high mesh (with normals) that the point `low_point` of a simplified mesh stands for. Rays go
/// along the unit vector `low_normal`, outwards and inwards; among the hits whose surface faces the same side the
/// nearest wins, with oblique ones counting as farther than they are. A hit much farther than the nearest point that
/// faces the same side is not believed, because it lies on another part of the object. Where no hit is left, the match
/// is the nearest point within four cages that faces the same side, else the nearest point of all. A mesh that has
/// triangles always gives a point.
SurfaceMatch match_surface(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                           const Eigen::Vector3f& low_normal, const MatchLimits& limits);

/// Finds it through an artist's cage, a point of which lies at `low_point + offset`: the first front of a triangle that
/// a ray from there to the low point meets, on its way or as far again behind the low point. The cage is believed: no
/// nearer surface takes the place of a hit. Where nothing is hit, the match is as that of match_surface without a hit,
/// the offset's length being the cage.
SurfaceMatch match_through_cage(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                                const Eigen::Vector3f& offset, const Eigen::Vector3f& low_normal,
                                float surface_tolerance);

}  // namespace kiln
