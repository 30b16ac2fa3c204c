// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <embree3/rtcore.h>
#include <limits>
#include <span>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// A ray as Embree has it, from `nearest` to `farthest` times the direction.
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

/// An Embree device with one scene, of one mesh. Only for sources of this room: it shows Embree's own types.
class EmbreeScene {
 public:
  /// The positions and triangles outlive the scene. rtcOccluded1M does not count hits that is_before finds to lie
  /// behind the ray's origin. Which of two triangles a query on their edge gets does not depend on the number of
  /// threads.
  EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles);

  /// For all hits of rays, whose order means nothing: built in a fraction of the time. `filter` is asked about every
  /// hit of rtcIntersect1, not of rtcOccluded1, and gets `filter_data`, which outlives the scene
  /// (rtcSetGeometryIntersectFilterFunction).
  EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
              RTCFilterFunctionN filter, void* filter_data);
  ~EmbreeScene();
  EmbreeScene(const EmbreeScene&) = delete;
  EmbreeScene& operator=(const EmbreeScene&) = delete;

  RTCScene scene() const { return scene_; }

  /// Whether a hit of `triangle` at `distance` from `origin` is none: in doubt, and behind it.
  bool is_behind(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, std::uint32_t triangle,
                 float distance) const;

 private:
  void build(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles, RTCBuildQuality quality,
             RTCFilterFunctionN filter, void* filter_data, RTCFilterFunctionN occlusion_filter);
  void commit();

  /// What the occlusion filter needs.
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
