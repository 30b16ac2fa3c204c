// SPDX-License-Identifier: MIT
#include "runtime/shadow/ray_occluder.h"

#include <algorithm>
#include <embree3/rtcore.h>
#include <limits>
#include <new>
#include <stdexcept>

#include "base/errors.h"
#include "base/one_thread.h"
#include "runtime/shadow/placed_nodes.h"

namespace kiln {

namespace {

constexpr std::size_t packet_rays = 16;
constexpr float infinity = std::numeric_limits<float>::infinity();

/// Returns the device of all scenes, which is never released.
RTCDevice device_of_all() {
  static const RTCDevice device = rtcNewDevice(nullptr);
  return device;
}

/// Rays in packets, from one origin.
struct RayPacket {
  alignas(64) RTCRay16 rays;
  alignas(64) int valid[packet_rays];

  void set(std::size_t lane, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
           float farthest) {
    rays.org_x[lane] = origin.x();
    rays.org_y[lane] = origin.y();
    rays.org_z[lane] = origin.z();
    rays.dir_x[lane] = direction.x();
    rays.dir_y[lane] = direction.y();
    rays.dir_z[lane] = direction.z();
    rays.tnear[lane] = nearest;
    rays.tfar[lane] = farthest;
    rays.time[lane] = 0;
    rays.mask[lane] = ~0u;
    rays.flags[lane] = 0;
  }
};

}  // namespace

struct RayOccluder::Implementation {
  RTCScene scene = nullptr;
  float nearest = 0;  ///< object units
  OccluderOutline outline;

  Implementation() = default;
  Implementation(const Implementation&) = delete;
  Implementation& operator=(const Implementation&) = delete;
  ~Implementation() {
    if (scene != nullptr) rtcReleaseScene(scene);
  }
};

RayOccluder::RayOccluder(const TriangleMesh& mesh) : implementation_(std::make_unique<Implementation>()) {
  implementation_->nearest = static_cast<float>(touching_share * std::max(0.0, bounding_ball(mesh).radius));
  const RTCDevice device = device_of_all();
  if (device == nullptr) throw MachineLacks("Embree finds no device it can run on");
  implementation_->scene = rtcNewScene(device);
  // Robust: no ray slips through between two triangles.
  rtcSetSceneFlags(implementation_->scene, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(implementation_->scene, RTC_BUILD_QUALITY_HIGH);
  if (!mesh.triangles.empty()) {
    const RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<float*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3,
                                                                 3 * sizeof(float), mesh.positions.size()));
    auto* corners = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, sizeof(Triangle), mesh.triangles.size()));
    if (vertices == nullptr || corners == nullptr) {
      rtcReleaseGeometry(geometry);
      throw std::bad_alloc();
    }
    for (const Eigen::Vector3f& position : mesh.positions) vertices = std::copy_n(position.data(), 3, vertices);
    for (const Triangle& triangle : mesh.triangles) corners = std::copy(triangle.begin(), triangle.end(), corners);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(implementation_->scene, geometry);
    rtcReleaseGeometry(geometry);
  }
  implementation_->outline = outline_of(mesh);
  // Builds the tree with one thread, so that it does not depend on their number.
  on_one_thread([&] { rtcCommitScene(implementation_->scene); });
  if (rtcGetDeviceError(device) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build a scene of shadows");
}

RayOccluder::~RayOccluder() = default;
RayOccluder::RayOccluder(RayOccluder&&) noexcept = default;
RayOccluder& RayOccluder::operator=(RayOccluder&&) noexcept = default;

const OccluderOutline& RayOccluder::outline() const { return implementation_->outline; }

void RayOccluder::block(const Placement& placement, const Eigen::Vector3d& origin, const DirectionSet& set,
                        std::span<const std::uint32_t> which, std::span<const float> farthest,
                        std::span<std::uint8_t> blocked) const {
  const Eigen::Vector3f start = placement.to_object(origin).cast<float>();
  const Eigen::Matrix3f turn = placement.rotation.transpose().cast<float>();
  const auto unit = static_cast<float>(1 / placement.scale);
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  context.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
  RayPacket packet;
  for (std::size_t first = 0; first < which.size(); first += packet_rays) {
    const std::size_t rays = std::min(packet_rays, which.size() - first);
    for (std::size_t lane = 0; lane < packet_rays; ++lane) {
      packet.valid[lane] = lane < rays ? -1 : 0;
      const std::uint32_t d = which[first + std::min(lane, rays - 1)];
      packet.set(lane, start, turn * set.direction(d), implementation_->nearest,
                 farthest.empty() ? infinity : unit * farthest[d]);
    }
    rtcOccluded16(packet.valid, implementation_->scene, &context, &packet.rays);
    for (std::size_t lane = 0; lane < rays; ++lane)
      if (packet.rays.tfar[lane] < 0) blocked[which[first + lane]] = 1;
  }
}

bool RayOccluder::blocks(const Placement& placement, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                         float farthest) const {
  const Eigen::Vector3f start = placement.to_object(origin).cast<float>();
  const Eigen::Vector3f along = (placement.rotation.transpose() * direction).cast<float>();
  RTCIntersectContext context;
  rtcInitIntersectContext(&context);
  RTCRay ray = {};
  ray.org_x = start.x();
  ray.org_y = start.y();
  ray.org_z = start.z();
  ray.dir_x = along.x();
  ray.dir_y = along.y();
  ray.dir_z = along.z();
  ray.tnear = implementation_->nearest;
  ray.tfar = static_cast<float>(farthest / placement.scale);
  ray.mask = ~0u;
  rtcOccluded1(implementation_->scene, &context, &ray);
  return ray.tfar < 0;
}

}  // namespace kiln
