// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <embree3/rtcore.h>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// A path tracer for tests, which shares nothing with the bake except Embree: random paths by cosine, ray by ray,
/// albedo per triangle, geometric normals of the triangles that are hit.
class PathTracer {
 public:
  /// Stores the albedo of each triangle.
  PathTracer(const TriangleMesh& mesh, std::vector<Eigen::Vector3f> albedos)
      : mesh_(mesh), albedos_(std::move(albedos)), device_(rtcNewDevice(nullptr)), scene_(rtcNewScene(device_)) {
    RTCGeometry geometry = rtcNewGeometry(device_, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    for (const Eigen::Vector3f& p : mesh.positions)
      for (int axis = 0; axis < 3; ++axis) *vertices++ = p[axis];
    auto* corners = static_cast<unsigned*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(unsigned), mesh.triangles.size()));
    for (const Triangle& triangle : mesh.triangles)
      for (unsigned corner : triangle) *corners++ = corner;
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene_, geometry);
    rtcReleaseGeometry(geometry);
    rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
    rtcCommitScene(scene_);
  }
  ~PathTracer() {
    rtcReleaseScene(scene_);
    rtcReleaseDevice(device_);
  }
  PathTracer(const PathTracer&) = delete;
  PathTracer& operator=(const PathTracer&) = delete;

  /// Follows one random path from a point of albedo 1 with this normal; returns the sky's light, `sky(direction)`, if
  /// the path leaves the scene after at most `bounces` reflections, else 0.
  template <class Sky>
  Eigen::Vector3d path(Eigen::Vector3f point, Eigen::Vector3f normal, int bounces, float offset, const Sky& sky,
                       std::mt19937& random) const {
    Eigen::Vector3d throughput = Eigen::Vector3d::Ones();
    for (int bounce = 0; bounce <= bounces; ++bounce) {
      const Eigen::Vector3f direction = around(normal, random);
      const Eigen::Vector3f origin = point + offset * normal;
      RTCRayHit query = {};
      query.ray = {origin.x(),
                   origin.y(),
                   origin.z(),
                   0,
                   direction.x(),
                   direction.y(),
                   direction.z(),
                   0,
                   std::numeric_limits<float>::infinity(),
                   ~0u,
                   0,
                   0};
      query.hit.geomID = RTC_INVALID_GEOMETRY_ID;
      RTCIntersectContext context;
      rtcInitIntersectContext(&context);
      rtcIntersect1(scene_, &context, &query);
      if (query.hit.geomID == RTC_INVALID_GEOMETRY_ID) return throughput * sky(direction);
      const auto& [a, b, c] = mesh_.triangles[query.hit.primID];
      normal = (mesh_.positions[b] - mesh_.positions[a]).cross(mesh_.positions[c] - mesh_.positions[a]).normalized();
      if (normal.dot(direction) >= 0) break;  // a back face
      throughput = throughput.cwiseProduct(albedos_[query.hit.primID].cast<double>());
      point = origin + query.ray.tfar * direction;
    }
    return Eigen::Vector3d::Zero();
  }

 private:
  /// Samples a direction with the density cosine / pi.
  static Eigen::Vector3f around(const Eigen::Vector3f& normal, std::mt19937& random) {
    std::uniform_real_distribution<float> uniform(0, 1);
    const float squared = uniform(random), angle = 2 * std::numbers::pi_v<float> * uniform(random);
    const float radius = std::sqrt(squared);
    const Eigen::Vector3f first = normal.unitOrthogonal(), second = normal.cross(first);
    return radius * std::cos(angle) * first + radius * std::sin(angle) * second + std::sqrt(1 - squared) * normal;
  }

  const TriangleMesh& mesh_;
  std::vector<Eigen::Vector3f> albedos_;
  RTCDevice device_;
  RTCScene scene_;
};

}  // namespace kiln
