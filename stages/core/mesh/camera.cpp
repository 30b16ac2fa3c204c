// SPDX-License-Identifier: MIT
#include "mesh/camera.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
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

namespace {

/// Extent of a shape across the picture and along the view, about the middle of its box: the positions of the two
/// planes, inclined as the picture's sides, that touch its outermost vertices.
struct Wedge {
  double slope;  ///< slope of the sides, across over along
  double lowest = std::numeric_limits<double>::infinity(), highest = -lowest;

  /// Extends the planes to a vertex.
  void add(double across, double along) {
    lowest = std::min(lowest, across + slope * along);
    highest = std::max(highest, across - slope * along);
  }
  /// Returns how far forwards an eye between the planes may stand; the next function, how far across that is.
  double eye_along() const { return (lowest - highest) / (2 * slope); }
  double eye_across() const { return 0.5 * (lowest + highest); }
  /// Returns how far forwards an eye at `across` may stand.
  double eye_along(double across) const { return std::min(lowest - across, across - highest) / slope; }
};

/// Sets the depth range of a shape as seen by a camera; vertices behind it do not count.
void set_depths(Camera& camera, std::span<const Eigen::Vector3f> shape) {
  double nearest = std::numeric_limits<double>::infinity(), farthest = 0;
  for (const Eigen::Vector3f& vertex : shape) {
    const double depth = (vertex - camera.position).cast<double>().dot(camera.forward.cast<double>());
    if (depth > 0) nearest = std::min(nearest, depth);
    farthest = std::max(farthest, depth);
  }
  if (farthest <= 0) farthest = 1;  // the whole shape lies behind
  // Depth is stored in floats, which cannot tell depths nearer than a thousandth of the farthest apart.
  camera.near_distance = static_cast<float>(std::max(0.99 * std::min(nearest, farthest), 1e-3 * farthest));
  camera.far_distance = static_cast<float>(1.01 * farthest);
}

}  // namespace

Camera make_camera(std::span<const Eigen::Vector3f> shape, const CameraSettings& settings, int width, int height) {
  const double degree = std::numbers::pi / 180;
  const double azimuth = settings.azimuth_degrees * degree;
  // Seen straight from above or below, "up" would be undefined.
  const double elevation = std::clamp(settings.elevation_degrees, -89.9, 89.9) * degree;
  const Eigen::Vector3d outwards(std::cos(elevation) * std::sin(azimuth), std::sin(elevation),
                                 std::cos(elevation) * std::cos(azimuth));
  const double half_height = std::tan(settings.field_of_view_degrees * degree / 2);
  const double half_width = half_height * width / height;

  Camera camera;
  camera.forward = (-outwards).cast<float>();
  camera.right = camera.forward.cross(Eigen::Vector3f::UnitY()).normalized();
  camera.up = camera.right.cross(camera.forward);
  const Eigen::Vector3d forward = camera.forward.cast<double>(), right = camera.right.cast<double>(),
                        up = camera.up.cast<double>();

  // Fit the silhouette.
  Eigen::AlignedBox3d box;
  for (const Eigen::Vector3f& vertex : shape) box.extend(vertex.cast<double>());
  const Eigen::Vector3d middle = settings.target.value_or(box.center());
  Wedge across{half_width / settings.margin}, upwards{half_height / settings.margin};
  for (const Eigen::Vector3f& vertex : shape) {
    const Eigen::Vector3d place = vertex.cast<double>() - middle;
    across.add(place.dot(right), place.dot(forward));
    upwards.add(place.dot(up), place.dot(forward));
  }
  const double least = 1e-6 * std::max(box.diagonal().norm(), 1e-24);  // for a single point
  Eigen::Vector3d eye;  // relative to the middle, along right, up and forward
  if (settings.target)
    eye = {0, 0, std::min(across.eye_along(0), upwards.eye_along(0))};
  else
    eye = {across.eye_across(), upwards.eye_across(), std::min(across.eye_along(), upwards.eye_along())};
  eye.z() = std::min(eye.z(), -least);
  if (settings.distance > 0) eye.z() = -settings.distance;

  camera.target = middle + eye.x() * right + eye.y() * up;
  camera.position = (camera.target + eye.z() * forward).cast<float>();
  camera.half_height = static_cast<float>(half_height / settings.zoom);
  camera.half_width = static_cast<float>(half_width / settings.zoom);
  set_depths(camera, shape);
  return camera;
}

}  // namespace kiln
