// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/surface_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace kiln {

namespace {

constexpr int most_hits_per_ray = 64;

/// Largest believable ratio of a hit's distance to that of the nearest agreeing point; a farther hit is on another part
/// of the object. Rays along an interpolated normal lengthen distances by the cosine between it and the high surface,
/// which is seldom below a quarter.
constexpr float largest_detour = 4;

struct RayHit {
  SurfacePoint point;
  float cosine = 0;  ///< between the low normal and the high surface's

  /// Returns the cost, the least of which wins: the hit's distance, longer the more oblique it is.
  float cost() const { return point.distance / cosine; }
};

/// Finds the first hit along `direction` whose face and interpolated normal agree with `low_normal`.
RayHit first_agreeing_hit(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                          const Eigen::Vector3f& direction, const Eigen::Vector3f& low_normal,
                          const MatchLimits& limits) {
  // Start a little behind the low point, so that rounding does not miss a surface that coincides with the low one.
  const Eigen::Vector3f origin = low_point - limits.surface_tolerance * direction;
  const float farthest = limits.cage_distance + limits.surface_tolerance;
  float nearest = 0;
  for (int k = 0; k < most_hits_per_ray; ++k) {
    SurfacePoint hit = scene.first_hit(origin, direction, nearest, farthest);
    if (!hit.found()) return {};
    const float cosine =
        std::min(face_normal(high, hit.triangle).dot(low_normal), normal_at(high, hit).dot(low_normal));
    if (cosine > 0) {
      nearest = hit.distance;
      hit.distance = std::abs(hit.distance - limits.surface_tolerance);
      return {hit, cosine};
    }
    // Continue past the hit, by more than rounding.
    nearest = hit.distance + std::max(0.01f * limits.surface_tolerance, hit.distance * 1e-6f);
  }
  return {};
}

/// Finds the match of a point whose rays hit nothing.
SurfaceMatch match_nearest(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                           const Eigen::Vector3f& low_normal, const MatchLimits& limits) {
  // A point that faces the other side would be worse than one that is a little far.
  const SurfacePoint agreeing =
      scene.closest_facing_point(low_point, low_normal, largest_detour * limits.cage_distance);
  if (agreeing.found()) return {agreeing, MatchWay::nearest_point, true};
  SurfaceMatch nearest{scene.closest_point(low_point, std::numeric_limits<float>::infinity()), MatchWay::nearest_point,
                       false};
  // At a hard edge both sides are equally near: take the one that agrees.
  const SurfacePoint side =
      scene.closest_facing_point(low_point, low_normal, 1.001f * nearest.point.distance + limits.surface_tolerance);
  if (side.found()) return {side, MatchWay::nearest_point, true};
  nearest.agrees = face_normal(high, nearest.point.triangle).dot(low_normal) > 0;
  return nearest;
}

}  // namespace

SurfaceMatch match_surface(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                           const Eigen::Vector3f& low_normal, const MatchLimits& limits) {
  // Trace rays both ways; take the less far and less oblique hit.
  const RayHit outwards = first_agreeing_hit(high, scene, low_point, low_normal, low_normal, limits);
  const RayHit inwards = first_agreeing_hit(high, scene, low_point, -low_normal, low_normal, limits);
  if (outwards.point.found() || inwards.point.found()) {
    const bool take_outwards = outwards.point.found() && (!inwards.point.found() || outwards.cost() <= inwards.cost());
    const SurfacePoint& hit = take_outwards ? outwards.point : inwards.point;

    // Check whether surface that faces the same side is much nearer.
    const float believable = (hit.distance - limits.surface_tolerance) / largest_detour;
    const SurfacePoint nearer =
        believable > 0 ? scene.closest_facing_point(low_point, low_normal, believable) : SurfacePoint{};
    if (!nearer.found()) return {hit, take_outwards ? MatchWay::ray_outwards : MatchWay::ray_inwards, true};
    return {nearer, MatchWay::nearest_point, true};
  }

  return match_nearest(high, scene, low_point, low_normal, limits);
}

SurfaceMatch match_through_cage(const TriangleMesh& high, const PartScene& scene, const Eigen::Vector3f& low_point,
                                const Eigen::Vector3f& offset, const Eigen::Vector3f& low_normal,
                                float surface_tolerance) {
  const float length = offset.norm();
  const Eigen::Vector3f outwards = length > 0 ? Eigen::Vector3f(offset / length) : low_normal;
  // Start a little outside the cage, so that rounding does not miss a surface that coincides with it.
  const Eigen::Vector3f origin = low_point + offset + surface_tolerance * outwards;
  const float farthest = 2 * (length + surface_tolerance);
  float nearest = 0;
  for (int k = 0; k < most_hits_per_ray; ++k) {
    SurfacePoint hit = scene.first_hit(origin, -outwards, nearest, farthest);
    if (!hit.found()) break;
    if (face_normal(high, hit.triangle).dot(outwards) > 0) {
      const float outside = length + surface_tolerance - hit.distance;
      hit.distance = std::abs(outside);
      return {hit, outside >= 0 ? MatchWay::ray_outwards : MatchWay::ray_inwards, true};
    }
    // Continue past the hit, by more than rounding.
    nearest = hit.distance + std::max(0.01f * surface_tolerance, hit.distance * 1e-6f);
  }
  return match_nearest(high, scene, low_point, low_normal, {length, surface_tolerance});
}

}  // namespace kiln
