// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <gtest/gtest.h>
#include <numeric>

#include "bake/integrate/unoccluded.h"
#include "bake/scene/occluders.h"
#include "import/import_mesh.h"
#include "raycast/ray_scene.h"
#include "sh/directions.h"
#include "shapes.h"

namespace kiln {
namespace test_unoccluded {

constexpr float lift = 1e-3f;

TEST(Unoccluded, WholeSphereIsFree) {
  const TriangleMesh mesh = shapes::icosphere(4);
  // Receivers stand at the corners, with the sphere's normals: all else lies below.
  const std::vector<std::uint8_t> free = unoccluded_receivers(mesh.positions, {mesh.positions, mesh.positions}, lift);
  EXPECT_EQ(std::accumulate(free.begin(), free.end(), std::size_t{0}), mesh.positions.size());
  // Inside, nothing is.
  std::vector<Eigen::Vector3f> inside, normals;
  for (const Eigen::Vector3f& p : mesh.positions) {
    inside.push_back(0.9f * p);
    normals.push_back(p);
  }
  const std::vector<std::uint8_t> shut = unoccluded_receivers(mesh.positions, {inside, normals}, lift);
  EXPECT_EQ(std::accumulate(shut.begin(), shut.end(), 0), 0);
}

TEST(Unoccluded, PlaneIsFreeUntilSomethingStandsOnIt) {
  const TriangleMesh mesh = shapes::plane(5);
  std::vector<Eigen::Vector3f> corners = mesh.positions;
  const std::vector<Eigen::Vector3f> up(corners.size(), Eigen::Vector3f(0, 1, 0));
  const Receivers receivers{mesh.positions, up};
  for (std::uint8_t free : unoccluded_receivers(corners, receivers, lift)) EXPECT_EQ(free, 1);
  corners.emplace_back(0.f, 2 * lift, 0.f);
  for (std::uint8_t free : unoccluded_receivers(corners, receivers, lift)) EXPECT_EQ(free, 0);
  for (std::uint8_t free : unoccluded_receivers({}, receivers, lift)) EXPECT_EQ(free, 1);
}

TEST(Unoccluded, EveryRayOfAFreeReceiverOfTheBunnyIsFree) {
  TriangleMesh mesh = load_mesh("/usr/share/glmark2/models/bunny.obj");
  const Occluders occluders = join_occluders({mesh});
  compute_vertex_normals(mesh);
  const Receivers receivers{mesh.positions, mesh.normals};
  const std::vector<std::uint8_t> free = unoccluded_receivers(occluders.hull, receivers, lift);
  const RayScene scene(mesh);
  int count = 0;
  for (std::size_t r = 0; r < free.size(); ++r) {
    if (free[r] == 0) continue;
    ++count;
    for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, 300, r)) {
      if (direction.dot(mesh.normals[r]) <= 0) continue;
      ASSERT_FALSE(scene.first_hit(mesh.positions[r] + lift * mesh.normals[r], direction, 0, 1e9f).found());
    }
  }
  EXPECT_GT(count, 20);
}

}  // namespace test_unoccluded
}  // namespace kiln
