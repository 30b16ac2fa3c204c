// SPDX-License-Identifier: MIT
#include "mesh/camera_record.h"

#include "base/json.h"

namespace kiln {

namespace {

template <class Vector>
Json list(const Vector& v) {
  return {v.x(), v.y(), v.z()};
}

Eigen::Vector3f vector_of(const Json& json) {
  return {json.at(0).get<float>(), json.at(1).get<float>(), json.at(2).get<float>()};
}

}  // namespace

Json to_json(const Camera& camera) {
  const Eigen::Matrix4f matrix = camera.clip_from_object();
  Json rows = Json::array();
  for (int row = 0; row < 4; ++row) rows.push_back({matrix(row, 0), matrix(row, 1), matrix(row, 2), matrix(row, 3)});
  return {{"position", list(camera.position)},   {"target", list(camera.target)},
          {"right", list(camera.right)},         {"up", list(camera.up)},
          {"forward", list(camera.forward)},     {"half_width", camera.half_width},
          {"half_height", camera.half_height},   {"near_distance", camera.near_distance},
          {"far_distance", camera.far_distance}, {"clip_from_object", rows}};
}

Camera camera_of_json(const Json& json) {
  Camera camera;
  camera.position = vector_of(json.at("position"));
  const Json& target = json.at("target");
  camera.target = {target.at(0).get<double>(), target.at(1).get<double>(), target.at(2).get<double>()};
  camera.right = vector_of(json.at("right"));
  camera.up = vector_of(json.at("up"));
  camera.forward = vector_of(json.at("forward"));
  camera.half_width = json.at("half_width").get<float>();
  camera.half_height = json.at("half_height").get<float>();
  camera.near_distance = json.at("near_distance").get<float>();
  camera.far_distance = json.at("far_distance").get<float>();
  return camera;
}

}  // namespace kiln
