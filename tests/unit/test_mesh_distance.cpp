// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <vector>

#include "base/parallel.h"
#include "mesh/mesh_distance.h"
#include "mesh/nearest_surface.h"
#include "shapes.h"

namespace kiln {
namespace test_mesh_distance {

TEST(MeshDistance, OfAMeshToItselfIsZero) {
  const TriangleMesh sphere = shapes::icosphere(3);
  const MeshDistance distance = mesh_distance(sphere, sphere);
  // Samples lie on their triangle up to the rounding of doubles.
  EXPECT_LT(distance.hausdorff, 1e-14);
  EXPECT_LT(distance.rms, 1e-15);
}

TEST(MeshDistance, OfParallelPlanesIsTheirGap) {
  const MeshDistance distance = mesh_distance(shapes::plane(4, 1, 0), shapes::plane(7, 1, 0.25f));
  const double expected = 0.25 / std::sqrt(2.0);  // the unit square's diagonal
  // Positions are floats.
  EXPECT_NEAR(distance.hausdorff, expected, 1e-7);
  EXPECT_NEAR(distance.rms, expected, 1e-7);
  EXPECT_NEAR(distance.rms_from_second, expected, 1e-7);
}

TEST(MeshDistance, IsOneSidedWhereOneMeshIsPartOfTheOther) {
  // The middle half of a unit square. From the square: the corners are farthest, and the mean square is the integral of
  // the squared distance to the inner square, 4 sides of 1/2 * (1/4)^3 / 3 and 4 corners of 2 * (1/4)^4 / 3.
  const MeshDistance distance = mesh_distance(shapes::plane(8, 1), shapes::plane(4, 0.5f));
  const double diagonal = std::sqrt(2.0);
  EXPECT_LT(distance.hausdorff_from_second, 1e-12);
  EXPECT_NEAR(distance.hausdorff_from_first, 0.25 * std::sqrt(2.0) / diagonal, 1e-7);
  EXPECT_EQ(distance.hausdorff, distance.hausdorff_from_first);
  const double mean_square = 4 * 0.5 * std::pow(0.25, 3) / 3 + 4 * 2 * std::pow(0.25, 4) / 3;
  // 200,000 samples of a quantity whose spread is of its own size: 0.25 %, less by stratification.
  EXPECT_NEAR(distance.rms_from_first, std::sqrt(mean_square) / diagonal, 0.003 * std::sqrt(mean_square) / diagonal);
}

TEST(MeshDistance, OfConcentricSpheresIsTheDifferenceOfRadii) {
  const MeshDistance distance = mesh_distance(shapes::icosphere(5, 1), shapes::icosphere(5, 1.1f));
  const double diagonal = 2 * std::sqrt(3.0);
  // 20,480 triangles stay within 0.0004 of a unit sphere: 1 - cos of half an edge of 0.04 in the middle of a triangle.
  EXPECT_NEAR(distance.hausdorff, 0.1 / diagonal, 0.0005 / diagonal);
  EXPECT_NEAR(distance.rms, 0.1 / diagonal, 0.0005 / diagonal);
}

TEST(MeshDistance, ScalesWithTheFirstDiagonal) {
  const double small = mesh_distance(shapes::icosphere(3, 1e-3f), shapes::icosphere(2, 1e-3f)).rms;
  const double large = mesh_distance(shapes::icosphere(3, 1e3f), shapes::icosphere(2, 1e3f)).rms;
  // Radii are rounded to float before they multiply positions.
  EXPECT_NEAR(small, large, 1e-6);
}

TEST(MeshDistance, IsTheSameOnOneThreadAndTwo) {
  const TriangleMesh fine = shapes::icosphere(4), coarse = shapes::icosphere(2);
  const auto measure = [&](std::size_t threads) {
    const ThreadLimit limit(threads);
    return mesh_distance(fine, coarse);
  };
  const MeshDistance one = measure(1), two = measure(2);
  EXPECT_EQ(one.hausdorff, two.hausdorff);
  EXPECT_EQ(one.rms_from_first, two.rms_from_first);
  EXPECT_EQ(one.rms_from_second, two.rms_from_second);
}

TEST(MeshDistance, RefusesAMeshWithoutArea) {
  EXPECT_THROW(mesh_distance(shapes::plane(1), TriangleMesh()), std::invalid_argument);
}

TEST(NearestSurface, FindsFacesEdgesAndCorners) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 4, 0}};
  mesh.triangles = {{0, 1, 2}};
  const NearestSurface surface(mesh);
  const auto expect_nearest = [&](const Eigen::Vector3d& point, const Eigen::Vector3d& expected) {
    const NearestSurface::Hit hit = surface.nearest(point);
    EXPECT_LT((hit.point - expected).norm(), 1e-12) << point.transpose() << ": " << hit.point.transpose();
    EXPECT_NEAR(hit.squared_distance, (point - expected).squaredNorm(), 1e-12);
    EXPECT_LT((surface.normal(hit) - Eigen::Vector3d::UnitZ()).norm(), 1e-12);
  };
  expect_nearest({1, 1, 2}, {1, 1, 0});
  expect_nearest({-1, -2, 1}, {0, 0, 0});
  expect_nearest({6, -1, 1}, {4, 0, 0});
  expect_nearest({-1, 6, -1}, {0, 4, 0});
  expect_nearest({1, -3, 1}, {1, 0, 0});
  expect_nearest({-3, 2, 1}, {0, 2, 0});
  expect_nearest({4, 2, 1}, {3, 1, 0});
}

TEST(NearestSurface, FindsTheSideThatFacesAWay) {
  // Two squares back to back, 0.01 apart, and a point just above the upper one.
  TriangleMesh lower = shapes::plane(4, 1, 0);
  for (Triangle& t : lower.triangles) std::swap(t[1], t[2]);
  const NearestSurface wall(shapes::joined(lower, shapes::plane(4, 1, 0.01f), Eigen::Vector3f::Zero()));
  const Eigen::Vector3d point(0.1, 0.012, 0.2), up = Eigen::Vector3d::UnitY();
  EXPECT_NEAR(wall.nearest_facing(point, {up})->point.y(), 0.01, 1e-6);
  EXPECT_NEAR(wall.nearest_facing(point, {-up})->point.y(), 0, 1e-6);
  EXPECT_FALSE(wall.nearest_facing(point, {-up, 0, 0.005}));
  EXPECT_TRUE(wall.nearest_facing(point, {-up, 0, 0.013}));
  EXPECT_FALSE(wall.nearest_facing(point, {Eigen::Vector3d::UnitX(), 0.1}));
}

TEST(NearestSurface, FacingAgreesWithEveryTriangleOnItsOwn) {
  const TriangleMesh torus = shapes::torus(12);
  const NearestSurface surface(torus);
  std::uint32_t hint = 0;
  for (int i = 0; i < 300; ++i) {
    const Eigen::Vector3d point(std::sin(7.0 * i), 0.5 * std::sin(13.0 * i), std::sin(3.0 * i + 1));
    const Eigen::Vector3d normal(std::cos(5.0 * i), std::sin(11.0 * i), std::cos(2.0 * i + 1));
    const double smallest_cosine = 0.9 * std::sin(1.7 * i);
    double expected = HUGE_VAL;
    for (const auto& [a, b, c] : torus.triangles) {
      const Eigen::Vector3d pa = torus.positions[a].cast<double>(), pb = torus.positions[b].cast<double>(),
                            pc = torus.positions[c].cast<double>();
      const Eigen::Vector3d face = (pb - pa).cross(pc - pa).normalized();
      // Floats decide which side of the bound a triangle is on; none of these is that near to it.
      if (face.dot(normal.normalized()) >= smallest_cosine)
        expected = std::min(expected, (nearest_on_triangle(point, pa, pb, pc) - point).squaredNorm());
    }
    const auto hit = surface.nearest_facing(point, {normal, smallest_cosine}, hint);
    ASSERT_EQ(hit.has_value(), expected < HUGE_VAL);
    if (!hit) continue;
    EXPECT_EQ(hit->squared_distance, expected);
    EXPECT_GE(surface.normal(*hit).dot(normal.normalized()), smallest_cosine);
    hint = hit->hint;
  }
}

TEST(NearestSurface, AgreesWithEveryTriangleOnItsOwn) {
  const TriangleMesh sheet = shapes::wavy_sheet(8);
  const NearestSurface surface(sheet);
  std::vector<NearestSurface> single;
  for (const Triangle& triangle : sheet.triangles) {
    TriangleMesh one = sheet;
    one.triangles = {triangle};
    single.emplace_back(one);
  }
  std::uint32_t hint = 0;
  for (int i = 0; i < 500; ++i) {
    const Eigen::Vector3d point =
        0.8 * Eigen::Vector3d(std::sin(7.0 * i), 0.5 * std::sin(13.0 * i), std::sin(3.0 * i + 1));
    double expected = HUGE_VAL;
    for (const NearestSurface& triangle : single)
      expected = std::min(expected, triangle.nearest(point).squared_distance);
    const NearestSurface::Hit hit = surface.nearest(point, hint);
    EXPECT_EQ(hit.squared_distance, expected);
    EXPECT_EQ(single[hit.triangle].nearest(point).squared_distance, expected);
    hint = hit.hint;
  }
}

}  // namespace test_mesh_distance
}  // namespace kiln
