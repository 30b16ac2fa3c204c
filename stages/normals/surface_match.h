#pragma once

#include <Eigen/Core>

#include "mesh/triangle_mesh.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// How the point of the high mesh was found.
enum class MatchWay { ray_outwards, ray_inwards, nearest_point };

struct SurfaceMatch {
  SurfacePoint point;  ///< of the high mesh; its distance is from the low point
  MatchWay way = MatchWay::nearest_point;
  bool agrees = true;  ///< the high surface faces the low normal's side there
};

/// How far to look and what to believe; distances in object units.
struct MatchLimits {
  float cage_distance = 0;      ///< rays go so far each way
  float surface_tolerance = 0;  ///< distances below it are rounding
};

/// The point of the high mesh (with normals) that the point `low_point` of a simplified mesh stands for.
/// Rays go along the unit vector `low_normal`, outwards and inwards; of the hits whose surface faces the same side the
/// nearest wins, oblique ones counting as farther than they are. A hit much farther than the nearest point that faces
/// the same side is not believed: it lies on another part of the object. Where no hit is left, it is the nearest point
/// that faces the same side, within four cages, and then the nearest point of all. A mesh that has triangles always
/// gives a point.
SurfaceMatch match_surface(const TriangleMesh& high, const RayScene& scene, const Eigen::Vector3f& low_point,
                           const Eigen::Vector3f& low_normal, const MatchLimits& limits);

}  // namespace kiln
