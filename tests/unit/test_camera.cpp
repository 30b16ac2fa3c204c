#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

#include "mesh/camera.h"

namespace kiln {
namespace {

TEST(Camera, FillsThePictureWithTheBox) {
  BoundingBox box;
  box.lowest = {-1, 2, 3};
  box.highest = {4, 3, 5};
  for (const double azimuth : {0.0, 20.0, 135.0, -90.0})
    for (const double elevation : {-90.0, -20.0, 0.0, 45.0, 90.0}) {
      CameraSettings settings;
      settings.azimuth_degrees = azimuth;
      settings.elevation_degrees = elevation;
      const Camera camera = make_camera(box, settings, 300, 200);
      float widest = 0;
      for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3f p((corner & 1) != 0 ? 4.f : -1.f, (corner & 2) != 0 ? 3.f : 2.f,
                                (corner & 4) != 0 ? 5.f : 3.f);
        const Eigen::Vector4f clip = camera.clip_from_object() * p.homogeneous();
        ASSERT_GT(clip.w(), 0);
        widest = std::max({widest, std::abs(clip.x() / clip.w()), std::abs(clip.y() / clip.w())});
        EXPECT_LE(std::abs(clip.z()), clip.w());
      }
      // Some corner touches the margin, or the camera stands as near as it may.
      EXPECT_LE(widest, 1 / settings.margin + 1e-4);
      EXPECT_GE(widest, 0.6);
    }
}

TEST(Camera, PixelDirectionsAgreeWithTheMatrix) {
  BoundingBox box;
  box.lowest = {-1, -1, -1};
  box.highest = {1, 1, 1};
  const Camera camera = make_camera(box, {}, 64, 48);
  const Eigen::Vector3f direction = camera.pixel_direction(10, 40, 64, 48);
  const Eigen::Vector3f point = camera.position + 3 * direction;
  const Eigen::Vector4f clip = camera.clip_from_object() * point.homogeneous();
  EXPECT_NEAR(clip.x() / clip.w(), 2 * 10.5 / 64 - 1, 1e-5);
  EXPECT_NEAR(clip.y() / clip.w(), 2 * 40.5 / 48 - 1, 1e-5);
}

}  // namespace
}  // namespace kiln
