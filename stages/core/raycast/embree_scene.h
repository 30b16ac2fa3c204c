// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <embree3/rtcore.h>
#include <limits>
#include <span>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Makes an Embree ray, from `nearest` to `farthest` times the direction.
inline RTCRay make_ray(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest = 0,
                       float farthest = std::numeric_limits<float>::infinity()) {
  RTCRay ray = {};
  ray.org_x = origin.x();
  ray.org_y = origin.y();
  ray.org_z = origin.z();
  ray.tnear = nearest;
  ray.dir_x = direction.x();
  ray.dir_y = direction.y();
  ray.dir_z = direction.z();
  ray.tfar = farthest;
  ray.mask = ~0u;
  return ray;
}

/// An Embree device with one scene of one mesh. Only for sources of this room, since it shows Embree's own types.
class EmbreeScene {
 public:
  /// Builds the scene of `positions` and `triangles`, which must outlive it. rtcOccluded1M ignores hits that is_before
  /// finds behind the ray's origin. Which of two triangles a query on their common edge returns does not depend on the
  /// number of threads.
  EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles);

  /// Builds a scene for collecting all hits of rays, in any order, in a fraction of the time. `filter` is called for
  /// every hit of rtcIntersect1, not of rtcOccluded1, with `filter_data`, which must outlive the scene
  /// (rtcSetGeometryIntersectFilterFunction).
  EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
              RTCFilterFunctionN filter, void* filter_data);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }

  /// Tests whether a hit of `triangle` at `distance` from `origin` is false: near enough to be doubtful, and behind the
  /// origin.
  bool is_behind(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, std::uint32_t triangle,
                 float distance) const;

 private:
  void build(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles, RTCBuildQuality quality,
             RTCFilterFunctionN filter, void* filter_data, RTCFilterFunctionN occlusion_filter);
  void commit();

  /// Data of the occlusion filter.
  struct Surface {
    std::span<const Eigen::Vector3f> positions;
    std::span<const Triangle> triangles;
    float doubtful = 0;
  };
  static void refuse_behind(const RTCFilterFunctionNArguments* arguments);

  Surface surface_;
  RTCDevice device_;
  RTCScene scene_ = nullptr;
};

}  // namespace kiln
