// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <vector>

#include "base/json.h"
#include "mesh/camera.h"
#include "mesh/camera_record.h"

namespace kiln {
namespace test_camera {

using Shape = std::vector<Eigen::Vector3f>;

Shape corners_of(const Eigen::Vector3f& lowest, const Eigen::Vector3f& highest) {
  Shape corners;
  for (int k = 0; k < 8; ++k)
    corners.emplace_back((k & 1) != 0 ? highest.x() : lowest.x(), (k & 2) != 0 ? highest.y() : lowest.y(),
                         (k & 4) != 0 ? highest.z() : lowest.z());
  return corners;
}

/// Makes a lopsided cloud of points, since real meshes are no boxes.
Shape cloud() {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  Shape points;
  for (int k = 0; k < 500; ++k)
    points.emplace_back(3 + normal(random), 0.2f * normal(random) * normal(random), normal(random));
  return points;
}

/// Finds the box of a shape in the picture: from -1 to 1 across and up.
struct Extents {
  float left = 9, right = -9, bottom = 9, top = -9;
};
Extents seen(const Camera& camera, const Shape& shape) {
  Extents extents;
  for (const Eigen::Vector3f& vertex : shape) {
    const Eigen::Vector4f clip = camera.clip_from_object() * vertex.homogeneous();
    EXPECT_GT(clip.w(), 0);
    EXPECT_LE(std::abs(clip.z()), clip.w());
    extents.left = std::min(extents.left, clip.x() / clip.w());
    extents.right = std::max(extents.right, clip.x() / clip.w());
    extents.bottom = std::min(extents.bottom, clip.y() / clip.w());
    extents.top = std::max(extents.top, clip.y() / clip.w());
  }
  return extents;
}

TEST(Camera, SilhouetteFillsThePicture) {
  for (const Shape& shape : {corners_of({-1, 2, 3}, {4, 3, 5}), corners_of({0, 0, 0}, {0.01f, 9, 0.01f}), cloud()})
    for (const double azimuth : {0.0, 20.0, 135.0, -90.0})
      for (const double elevation : {-90.0, -20.0, 0.0, 45.0, 90.0})
        for (const auto& [width, height] : {std::pair{300, 200}, {200, 300}}) {
          CameraSettings settings;
          settings.azimuth_degrees = azimuth;
          settings.elevation_degrees = elevation;
          const Extents extents = seen(make_camera(shape, settings, width, height), shape);
          const auto fill = static_cast<float>(1 / settings.margin);
          // Floats of a picture of a few hundred pixels.
          constexpr float rounding = 2e-4f;
          EXPECT_LE(std::max({-extents.left, extents.right, -extents.bottom, extents.top}), fill + rounding);
          // The shape touches the margin on both sides of one of the axes.
          EXPECT_GE(std::max(extents.right - extents.left, extents.top - extents.bottom), 2 * fill - 2 * rounding);
        }
}

TEST(Camera, StandsBeforeTheFront) {
  const Shape shape = corners_of({-1, 0, -1}, {1, 2, 1});
  const Camera camera = make_camera(shape, {}, 64, 64);
  EXPECT_GT(camera.position.z(), 3) << "+Z is the front";
  EXPECT_GT(camera.position.x(), 0);
  EXPECT_LT(camera.position.x(), 0.5f * camera.position.z()) << "azimuth 20";
}

TEST(Camera, TargetIsInTheMiddleAtItsDistance) {
  CameraSettings settings;
  settings.target = Eigen::Vector3d(3.5, 0, 0.5);
  for (const double distance : {0.0, 0.8, 40.0}) {
    settings.distance = distance;
    const Camera camera = make_camera(cloud(), settings, 90, 60);
    const Eigen::Vector4f clip = camera.clip_from_object() * Eigen::Vector4f(3.5f, 0, 0.5f, 1);
    EXPECT_NEAR(clip.x() / clip.w(), 0, 1e-5);
    EXPECT_NEAR(clip.y() / clip.w(), 0, 1e-5);
    EXPECT_EQ(camera.target, *settings.target);
    const double stands = (camera.position.cast<double>() - camera.target).norm();
    EXPECT_NEAR(stands, distance > 0 ? distance : stands, 1e-5 * distance);
    EXPECT_GT(camera.near_distance, 0);
    EXPECT_GT(camera.far_distance, camera.near_distance);
  }
  settings.distance = 0;  // all of it is still in the picture
  const Extents extents = seen(make_camera(cloud(), settings, 90, 60), cloud());
  EXPECT_NEAR(std::max({-extents.left, extents.right, -extents.bottom, extents.top}), 1 / settings.margin, 2e-4);
}

TEST(Camera, ZoomMagnifiesTheMiddle) {
  CameraSettings settings;
  const Camera whole = make_camera(cloud(), settings, 90, 60);
  settings.zoom = 4;
  const Camera near = make_camera(cloud(), settings, 90, 60);
  EXPECT_EQ(near.position, whole.position);
  for (const Eigen::Vector3f& vertex : cloud()) {
    const Eigen::Vector4f a = whole.clip_from_object() * vertex.homogeneous(),
                          b = near.clip_from_object() * vertex.homogeneous();
    EXPECT_NEAR(b.x() / b.w(), 4 * a.x() / a.w(), 1e-4);
    EXPECT_NEAR(b.y() / b.w(), 4 * a.y() / a.w(), 1e-4);
  }
}

TEST(Camera, OfOnePointIsACamera) {
  const Shape point = {{1, 2, 3}};
  EXPECT_TRUE(make_camera(point, {}, 64, 48).clip_from_object().allFinite());
}

TEST(Camera, IsRecordedToTheBit) {
  CameraSettings settings;
  settings.zoom = 1.7;
  const Camera camera = make_camera(cloud(), settings, 90, 60);
  const Camera read = camera_of_json(Json::parse(to_json(camera).dump()));
  EXPECT_EQ(read.clip_from_object(), camera.clip_from_object());
  EXPECT_EQ(read.pixel_direction(3, 50, 90, 60), camera.pixel_direction(3, 50, 90, 60));
  EXPECT_EQ(read.position, camera.position);
  EXPECT_EQ(read.target, camera.target);
}

TEST(Camera, PixelDirectionsAgreeWithTheMatrix) {
  const Camera camera = make_camera(corners_of({-1, -1, -1}, {1, 1, 1}), {}, 64, 48);
  const Eigen::Vector3f direction = camera.pixel_direction(10, 40, 64, 48);
  const Eigen::Vector3f point = camera.position + 3 * direction;
  const Eigen::Vector4f clip = camera.clip_from_object() * point.homogeneous();
  EXPECT_NEAR(clip.x() / clip.w(), 2 * 10.5 / 64 - 1, 1e-5);
  EXPECT_NEAR(clip.y() / clip.w(), 2 * 40.5 / 48 - 1, 1e-5);
}

}  // namespace test_camera
}  // namespace kiln
