// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/embree_scene.h"

#include <cstdint>
#include <new>
#include <stdexcept>

#include "base/errors.h"
#include "base/one_thread.h"
#include "raycast/exact_side.h"

namespace kiln {

namespace {

/// Returns the device of all scenes: hundreds of parts with one each would exhaust the machine. It is never released.
RTCDevice device_of_all() {
  static const RTCDevice device = rtcNewDevice(nullptr);
  return device;
}

/// Makes Embree's own copy of the buffers, padded as its wide loads need.
RTCGeometry make_geometry(RTCDevice device, std::span<const Eigen::Vector3f> positions,
                          std::span<const Triangle> triangles) {
  RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertex_buffer = static_cast<float*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, 3 * sizeof(float), positions.size()));
  auto* index_buffer = static_cast<std::uint32_t*>(rtcSetNewGeometryBuffer(
      geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(std::uint32_t), triangles.size()));
  if (vertex_buffer == nullptr || index_buffer == nullptr) {
    rtcReleaseGeometry(geometry);
    throw std::bad_alloc();
  }
  for (std::size_t i = 0; i < positions.size(); ++i)
    for (int axis = 0; axis < 3; ++axis) vertex_buffer[3 * i + axis] = positions[i][axis];
  for (std::size_t i = 0; i < triangles.size(); ++i)
    for (int corner = 0; corner < 3; ++corner) index_buffer[3 * i + corner] = triangles[i][corner];
  return geometry;
}

}  // namespace

EmbreeScene::EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles)
    : surface_{positions, triangles, doubtful_share * bounding_box(positions).diagonal()}, device_(device_of_all()) {
  build(positions, triangles, RTC_BUILD_QUALITY_HIGH, nullptr, this, refuse_behind);
  // Builds the tree with one thread, so that it does not depend on their number.
  on_one_thread([&] { commit(); });
}

EmbreeScene::EmbreeScene(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
                         RTCFilterFunctionN filter, void* filter_data)
    : device_(device_of_all()) {
  build(positions, triangles, RTC_BUILD_QUALITY_MEDIUM, filter, filter_data, nullptr);
  commit();
}

void EmbreeScene::build(std::span<const Eigen::Vector3f> positions, std::span<const Triangle> triangles,
                        RTCBuildQuality quality, RTCFilterFunctionN filter, void* filter_data,
                        RTCFilterFunctionN occlusion_filter) {
  if (device_ == nullptr) throw MachineLacks("Embree finds no device it can run on");
  scene_ = rtcNewScene(device_);
  // Robust: no ray slips through between two triangles.
  rtcSetSceneFlags(scene_, RTC_SCENE_FLAG_ROBUST);
  rtcSetSceneBuildQuality(scene_, quality);
  if (triangles.empty()) return;
  RTCGeometry geometry = make_geometry(device_, positions, triangles);
  rtcSetGeometryUserData(geometry, filter_data);
  rtcSetGeometryIntersectFilterFunction(geometry, filter);
  rtcSetGeometryOccludedFilterFunction(geometry, occlusion_filter);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(scene_, geometry);
  rtcReleaseGeometry(geometry);
}

void EmbreeScene::commit() {
  rtcCommitScene(scene_);
  if (rtcGetDeviceError(device_) != RTC_ERROR_NONE) throw std::runtime_error("Embree cannot build the scene");
}

bool EmbreeScene::is_behind(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, std::uint32_t triangle,
                            float distance) const {
  if (distance > surface_.doubtful) return false;
  const Triangle& t = surface_.triangles[triangle];
  return !is_before(origin, direction, surface_.positions[t[0]], surface_.positions[t[1]], surface_.positions[t[2]]);
}

void EmbreeScene::refuse_behind(const RTCFilterFunctionNArguments* arguments) {
  const auto& own = *static_cast<const EmbreeScene*>(arguments->geometryUserPtr);
  for (unsigned i = 0; i < arguments->N; ++i) {
    if (arguments->valid[i] == 0) continue;
    const float distance = RTCRayN_tfar(arguments->ray, arguments->N, i);
    if (distance > own.surface_.doubtful) continue;
    const Eigen::Vector3f origin(RTCRayN_org_x(arguments->ray, arguments->N, i),
                                 RTCRayN_org_y(arguments->ray, arguments->N, i),
                                 RTCRayN_org_z(arguments->ray, arguments->N, i));
    const Eigen::Vector3f direction(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                                    RTCRayN_dir_y(arguments->ray, arguments->N, i),
                                    RTCRayN_dir_z(arguments->ray, arguments->N, i));
    if (own.is_behind(origin, direction, RTCHitN_primID(arguments->hit, arguments->N, i), distance))
      arguments->valid[i] = 0;
  }
}

EmbreeScene::~EmbreeScene() {
  if (scene_ != nullptr) rtcReleaseScene(scene_);
}

}  // namespace kiln
