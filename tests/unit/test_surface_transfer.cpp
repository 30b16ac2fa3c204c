// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "base/parallel.h"
#include "raycast/surface_transfer.h"
#include "shapes.h"

namespace kiln {
namespace test_surface_transfer {

TEST(SurfaceTransfer, OutsideOfSphereIsUnoccluded) {
  const TriangleMesh sphere = shapes::icosphere(3);
  const std::vector<Eigen::Vector3f>& normals = sphere.positions;  // of a unit sphere
  const TransferVectors transfer = surface_transfer(sphere, {sphere.positions, normals}, {.bands = 2});
  for (std::size_t i = 0; i < sphere.positions.size(); ++i) {
    // 256 directions integrate the cosine lobe to 0.3 %, and at grazing angles a few meet facets beside the vertex.
    EXPECT_NEAR(transfer.plane(0)[i], 0.282095, 0.003);
    // Band 1 of a clamped cosine is 2/3 Y_1(n): Y_1^-1 = 0.488603 y.
    EXPECT_NEAR(transfer.plane(1)[i], 2. / 3 * 0.488603 * normals[i].y(), 0.005);
  }
}

TEST(SurfaceTransfer, InsideOfSphereIsDark) {
  const TriangleMesh sphere = shapes::icosphere(3);
  std::vector<Eigen::Vector3f> inwards;
  for (const Eigen::Vector3f& p : sphere.positions) inwards.push_back(-p);
  for (const float value : surface_openness(sphere, {sphere.positions, inwards})) EXPECT_EQ(value, 0);
}

/// Beside an endless wall whose top is seen at an elevation of phi, (1 - cos phi) / 2 of the cosine-weighted sky is
/// hidden.
TEST(SurfaceTransfer, FootOfWall) {
  TriangleMesh wall;
  wall.positions = {{-500, 0, 0}, {500, 0, 0}, {500, 1, 0}, {-500, 1, 0}};
  wall.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 2, 1}, {0, 3, 2}};
  std::vector<Eigen::Vector3f> positions;
  for (const float distance : {0.2f, 0.5f, 1.f, 2.f, 5.f}) positions.emplace_back(0.f, 0.f, distance);
  const std::vector<Eigen::Vector3f> normals(positions.size(), Eigen::Vector3f::UnitY());
  const std::vector<float> openness = surface_openness(wall, {positions, normals}, 4096);
  for (std::size_t i = 0; i < positions.size(); ++i) {
    const double phi = std::atan2(1.0, positions[i].z());
    EXPECT_NEAR(openness[i], 0.5 + 0.5 * std::cos(phi), 0.003) << "at " << positions[i].z();
  }
}

TEST(SurfaceTransfer, ThreadsChangeNoBit) {
  const TriangleMesh torus = shapes::torus(24);
  const std::vector<Eigen::Vector3f> normals(torus.positions.size(), Eigen::Vector3f::UnitX());
  const TransferVectors many = surface_transfer(torus, {torus.positions, normals});
  const ThreadLimit one_thread(1);
  EXPECT_EQ(surface_transfer(torus, {torus.positions, normals}).values, many.values);
}

}  // namespace test_surface_transfer
}  // namespace kiln
