#include <algorithm>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <vector>

#include "mesh/mesh_distance.h"
#include "mesh/nearest_surface.h"
#include "shapes.h"

namespace kiln {
namespace {

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
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
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

}  // namespace
}  // namespace kiln
