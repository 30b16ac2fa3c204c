// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <random>

#include "mesh/tangent_space.h"
#include "shapes.h"

namespace kiln {
namespace test_tangent_space {

TEST(TangentSpace, PlaneHasItsUvAxes) {
  const TriangleMesh mesh = shapes::plane(3);
  for (const TangentFrame& frame : tangent_frames(mesh)) {
    EXPECT_LT((frame.tangent - Eigen::Vector3f::UnitX()).norm(), 1e-6f);
    EXPECT_EQ(frame.sign, 1);  // n x t = Y x X = -Z, along which v grows
  }
}

TEST(TangentSpace, MirroredUvsTurnTheSign) {
  TriangleMesh mesh = shapes::plane(2);
  for (Eigen::Vector2f& uv : mesh.uvs) uv.x() = 1 - uv.x();
  for (const TangentFrame& frame : tangent_frames(mesh)) {
    EXPECT_LT((frame.tangent + Eigen::Vector3f::UnitX()).norm(), 1e-6f);
    EXPECT_EQ(frame.sign, -1);
  }
}

TEST(TangentSpace, FramesAreWeightedByTheCornersAngle) {
  // Two triangles meet at vertex 0 with angles of 90 and 45 degrees and face tangents along x and along -z:
  // MikkTSpace's tangent is their sum, 90 to 45.
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 0, -1}, {-1, 0, -1}};
  mesh.normals.assign(4, Eigen::Vector3f::UnitY());
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  // In the second triangle u grows along -z: from vertex 0 to 2 by du, and dP/du is (0, 0, -1) where 3 has the u of 2.
  mesh.uvs = {{0, 0}, {1, 0}, {0, 1}, {0, 0}};
  const Eigen::Vector2f split(1, 0);
  // Vertex 2 is split, so that the second triangle gets its own uvs there.
  mesh.positions.push_back(mesh.positions[2]);
  mesh.normals.push_back(mesh.normals[2]);
  mesh.uvs.push_back(split);
  mesh.uvs[3] = {1, 1};
  mesh.triangles[1] = {0, 4, 3};
  const TangentFrame frame = tangent_frames(mesh)[0];
  const Eigen::Vector3f wanted = Eigen::Vector3f(90, 0, -45).normalized();
  EXPECT_LT((frame.tangent - wanted).norm(), 1e-5f) << frame.tangent.transpose();
}

TEST(TangentSpace, TangentsLieInTheirVertexPlane) {
  const TriangleMesh mesh = shapes::cube_sphere(4);
  const std::vector<TangentFrame> frames = tangent_frames(mesh);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    EXPECT_NEAR(frames[i].tangent.norm(), 1, 1e-6);
    EXPECT_NEAR(frames[i].tangent.dot(mesh.normals[i]), 0, 1e-6);
    EXPECT_EQ(frames[i].sign, 1);
  }
}

TEST(TangentSpace, ThereAndBackAgain) {
  std::mt19937 random(3);
  std::normal_distribution<float> normal;
  const auto vector = [&] { return Eigen::Vector3f(normal(random), normal(random), normal(random)).normalized(); };
  for (int k = 0; k < 1000; ++k) {
    // Vectors are as after interpolation: neither of length one nor at right angles.
    const Eigen::Vector3f low_normal = vector() * 0.9f;
    const Eigen::Vector3f across = low_normal.cross(vector()).normalized();
    const TangentFrame frame{0.8f * across + 0.2f * low_normal, k % 2 == 0 ? 1.0f : -1.0f};
    const Eigen::Vector3f wanted = vector();
    const Eigen::Vector3f again =
        to_object_space(to_tangent_space(wanted, low_normal, frame), low_normal, frame).normalized();
    EXPECT_LT((again - wanted).norm(), 1e-5f);
  }
  // The low normal itself is straight up, whatever the frame.
  const TangentFrame frame{Eigen::Vector3f(0.6f, 0, 0.1f), -1};
  EXPECT_LT(
      (to_tangent_space(Eigen::Vector3f::UnitY(), 0.7f * Eigen::Vector3f::UnitY(), frame) - Eigen::Vector3f::UnitZ())
          .norm(),
      1e-6f);
}

TEST(TangentSpace, NothingToGoByStillGivesAFrame) {
  TriangleMesh mesh = shapes::plane(1);
  for (Eigen::Vector2f& uv : mesh.uvs) uv = {0.5f, 0.5f};
  for (const TangentFrame& frame : tangent_frames(mesh)) {
    EXPECT_NEAR(frame.tangent.norm(), 1, 1e-6);
    EXPECT_NEAR(frame.tangent.y(), 0, 1e-6);
  }
  EXPECT_EQ(to_tangent_space(Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY(), {Eigen::Vector3f::Zero(), 1}),
            Eigen::Vector3f::UnitZ());
  mesh.uvs.clear();
  EXPECT_THROW(tangent_frames(mesh), std::invalid_argument);
}

}  // namespace test_tangent_space
}  // namespace kiln
