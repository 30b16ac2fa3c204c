#include "mesh/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace kiln {

Eigen::Vector3f Camera::pixel_direction(int i, int j, int width, int height) const {
  const float x = (2 * (i + 0.5f) / width - 1) * half_width;
  const float y = (2 * (j + 0.5f) / height - 1) * half_height;
  return (forward + x * right + y * up).normalized();
}

Eigen::Matrix4f Camera::clip_from_object() const {
  Eigen::Matrix4f view = Eigen::Matrix4f::Identity();
  view.block<1, 3>(0, 0) = right.transpose();
  view.block<1, 3>(1, 0) = up.transpose();
  view.block<1, 3>(2, 0) = -forward.transpose();
  view.block<3, 1>(0, 3) = -view.block<3, 3>(0, 0) * position;
  Eigen::Matrix4f projection = Eigen::Matrix4f::Zero();
  projection(0, 0) = 1 / half_width;
  projection(1, 1) = 1 / half_height;
  projection(2, 2) = -(far_distance + near_distance) / (far_distance - near_distance);
  projection(2, 3) = -2 * far_distance * near_distance / (far_distance - near_distance);
  projection(3, 2) = -1;
  return projection * view;
}

Camera make_camera(const BoundingBox& box, const CameraSettings& settings, int width, int height) {
  const double degree = std::numbers::pi / 180;
  const double azimuth = settings.azimuth_degrees * degree;
  // Straight above or below, "up" would be undefined.
  const double elevation = std::clamp(settings.elevation_degrees, -89.9, 89.9) * degree;
  const Eigen::Vector3d outwards(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                 std::cos(elevation) * std::cos(azimuth));
  const double half_height = std::tan(settings.field_of_view_degrees * degree / 2);
  const double half_width = half_height * width / height;
  const double radius = std::max(0.5 * static_cast<double>(box.diagonal()), 1e-30);

  Camera camera;
  camera.forward = (-outwards).cast<float>();
  camera.right = camera.forward.cross(Eigen::Vector3f::UnitY()).normalized();
  camera.up = camera.right.cross(camera.forward);
  // The nearest place from which every corner of the box is in the picture, but not inside its bounding sphere.
  double distance = std::max(1.05 * radius, settings.least_distance);
  for (int corner = 0; corner < 8; ++corner) {
    const Eigen::Vector3f sign((corner & 1) != 0 ? 1.f : -1.f, (corner & 2) != 0 ? 1.f : -1.f,
                               (corner & 4) != 0 ? 1.f : -1.f);
    const Eigen::Vector3f from_centre = 0.5f * sign.cwiseProduct(box.highest - box.lowest);
    const double nearer = -from_centre.dot(camera.forward);
    distance = std::max({distance, nearer + settings.margin * std::abs(from_centre.dot(camera.right)) / half_width,
                         nearer + settings.margin * std::abs(from_centre.dot(camera.up)) / half_height});
  }
  camera.position = (box.centre().cast<double>() + distance * outwards).cast<float>();
  camera.half_height = static_cast<float>(half_height);
  camera.half_width = static_cast<float>(half_width);
  camera.near_distance = static_cast<float>(std::max(distance - 1.01 * radius, 0.01 * radius));
  camera.far_distance = static_cast<float>(distance + 1.01 * radius);
  return camera;
}

}  // namespace kiln
