// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>
#include <vector>

#include "base/parallel.h"
#include "raycast/ray_scene.h"
#include "shapes.h"

namespace kiln {
namespace test_raycast {

constexpr float infinity = std::numeric_limits<float>::infinity();

Eigen::Vector3f position(const TriangleMesh& mesh, const SurfacePoint& p) {
  const Triangle& t = mesh.triangles[p.triangle];
  return (1 - p.u - p.v) * mesh.positions[t[0]] + p.u * mesh.positions[t[1]] + p.v * mesh.positions[t[2]];
}

std::vector<Eigen::Vector3f> random_vectors(int count, float scale, int seed) {
  std::mt19937 random(seed);
  std::normal_distribution<float> normal(0, scale);
  std::vector<Eigen::Vector3f> vectors(static_cast<std::size_t>(count));
  for (Eigen::Vector3f& v : vectors) v = {normal(random), normal(random), normal(random)};
  return vectors;
}

TEST(RayScene, RaysMeetAPlaneWhereGeometrySaysSo) {
  const TriangleMesh mesh = shapes::plane(7, 2, 0.25f);
  const RayScene scene(mesh);
  for (const Eigen::Vector3f& origin : random_vectors(500, 0.7f, 1)) {
    const Eigen::Vector3f direction = (Eigen::Vector3f(0.3f, 0.25f, -0.2f) - origin).normalized();
    const SurfacePoint hit = scene.first_hit(origin, direction, 0, infinity);
    ASSERT_TRUE(hit.found());
    // All rays aim at one point of the plane. Rays almost along it have no better place than rounding over their slope.
    const float tolerance = 1e-5f / std::abs(direction.y());
    EXPECT_LT((position(mesh, hit) - Eigen::Vector3f(0.3f, 0.25f, -0.2f)).norm(), tolerance);
    EXPECT_NEAR(hit.distance, (Eigen::Vector3f(0.3f, 0.25f, -0.2f) - origin).norm(), tolerance);
    EXPECT_FALSE(scene.first_hit(origin, -direction, 0, infinity).found());
    EXPECT_FALSE(scene.first_hit(origin, direction, 0, 0.9f * hit.distance).found());
    EXPECT_FALSE(scene.first_hit(origin, direction, 1.1f * hit.distance, infinity).found());
  }
}

TEST(RayScene, RaysIntoASphereHitBothSides) {
  const TriangleMesh mesh = shapes::icosphere(5);
  const RayScene scene(mesh);
  // The chords of an icosphere of 5 levels lie at most (1 - cos(half an edge's angle)) = 4e-4 below the sphere.
  for (const Eigen::Vector3f& v : random_vectors(500, 1, 2)) {
    const Eigen::Vector3f direction = v.normalized();
    const SurfacePoint front = scene.first_hit(-3 * direction, direction, 0, infinity);
    ASSERT_TRUE(front.found());
    EXPECT_NEAR(front.distance, 2, 5e-4);
    const SurfacePoint back = scene.first_hit(-3 * direction, direction, front.distance + 0.01f, infinity);
    ASSERT_TRUE(back.found());
    EXPECT_NEAR(back.distance, 4, 5e-4);
  }
}

/// Finds the point of triangle abc closest to p by searching its plane, edges and corners, in double: slow and simple.
double distance_to_triangle(const Eigen::Vector3d& p, const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c) {
  const auto to_segment = [&](const Eigen::Vector3d& from, const Eigen::Vector3d& to) {
    const Eigen::Vector3d along = to - from;
    const double t = along.squaredNorm() > 0 ? std::clamp((p - from).dot(along) / along.squaredNorm(), 0.0, 1.0) : 0.0;
    return (p - from - t * along).norm();
  };
  double best = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
  const Eigen::Vector3d n = (b - a).cross(c - a);
  if (n.squaredNorm() > 0) {
    const Eigen::Vector3d foot = p - (p - a).dot(n) / n.squaredNorm() * n;
    const bool inside = (b - a).cross(foot - a).dot(n) >= 0 && (c - b).cross(foot - b).dot(n) >= 0 &&
                        (a - c).cross(foot - c).dot(n) >= 0;
    if (inside) best = std::min(best, (foot - p).norm());
  }
  return best;
}

TEST(RayScene, ClosestPointsAgreeWithBruteForce) {
  // A soup of triangles of all shapes, some without area.
  TriangleMesh mesh;
  mesh.positions = random_vectors(300, 1, 3);
  for (std::uint32_t k = 0; k < 100; ++k) mesh.triangles.push_back({3 * k, 3 * k + 1, 3 * k + 2});
  mesh.positions[31] = mesh.positions[30];
  mesh.positions[41] = 0.5f * (mesh.positions[39] + mesh.positions[40]);
  const RayScene scene(mesh);
  const Eigen::Vector3f facing = Eigen::Vector3f(1, 2, 3).normalized();
  for (const Eigen::Vector3f& p : random_vectors(500, 1.5f, 4)) {
    double best = infinity, best_facing = infinity;
    for (const Triangle& t : mesh.triangles) {
      const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
      const double distance =
          distance_to_triangle(p.cast<double>(), a.cast<double>(), b.cast<double>(), c.cast<double>());
      best = std::min(best, distance);
      if ((b - a).cross(c - a).dot(facing) > 0) best_facing = std::min(best_facing, distance);
    }
    // Float32 coordinates of size 1 to 5: a few of their roundings.
    const SurfacePoint found = scene.closest_point(p, infinity);
    ASSERT_TRUE(found.found());
    EXPECT_NEAR(found.distance, best, 5e-6);
    EXPECT_NEAR((position(mesh, found) - p).norm(), best, 5e-6);
    const SurfacePoint found_facing = scene.closest_facing_point(p, facing, infinity);
    ASSERT_TRUE(found_facing.found());
    EXPECT_NEAR(found_facing.distance, best_facing, 5e-6);
    EXPECT_FALSE(scene.closest_point(p, static_cast<float>(0.99 * best)).found());
    EXPECT_TRUE(scene.closest_point(p, static_cast<float>(1.01 * best)).found());
  }
}

TEST(RayScene, StreamsAgreeWithSingleRays) {
  const TriangleMesh mesh = shapes::icosphere(3);
  const RayScene scene(mesh);
  const std::vector<Eigen::Vector3f> origins = random_vectors(1000, 2, 5);  // no multiple of a stream's 256
  const Eigen::Vector3f direction = Eigen::Vector3f(-1, 0.5f, 0.25f).normalized();
  std::vector<std::uint8_t> shadowed(origins.size(), 7);
  scene.occluded(origins, direction, 0.001f, shadowed);
  int count = 0;
  for (std::size_t k = 0; k < origins.size(); ++k) {
    EXPECT_EQ(shadowed[k], scene.first_hit(origins[k], direction, 0.001f, infinity).found() ? 1 : 0);
    count += shadowed[k];
  }
  EXPECT_GT(count, 50);
  EXPECT_LT(count, 900);
}

TEST(RayScene, EmptyAndSmallScenes) {
  TriangleMesh mesh;
  const RayScene empty(mesh);
  EXPECT_FALSE(empty.first_hit({0, 0, 0}, {0, 0, 1}, 0, infinity).found());
  EXPECT_FALSE(empty.closest_point({0, 0, 0}, infinity).found());
  // A vertex buffer of one triangle: Embree reads past the last vertex by up to 16 bytes, which must be padded.
  mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const SurfacePoint hit = RayScene(mesh).first_hit({0.5f, 0.25f, 1}, {0, 0, -1}, 0, infinity);
  ASSERT_TRUE(hit.found());
  EXPECT_NEAR(hit.u, 0.5f, 1e-6);
  EXPECT_NEAR(hit.v, 0.25f, 1e-6);
}

TEST(RayScene, OneThreadAndManyBuildTheSameTree) {
  // Rays through shared edges and vertices: which triangle is reported depends on the tree.
  const TriangleMesh mesh = shapes::cube_sphere(40);
  const auto queries = [&](int threads) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    const RayScene scene(mesh);
    std::vector<std::uint32_t> triangles;
    for (const Eigen::Vector3f& p : mesh.positions) {
      triangles.push_back(scene.first_hit(2 * p, -p, 0, infinity).triangle);
      triangles.push_back(scene.closest_point(1.1f * p, infinity).triangle);
    }
    return triangles;
  };
  const std::vector<std::uint32_t> one = queries(1);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(one, queries(4));
}

}  // namespace test_raycast
}  // namespace kiln
