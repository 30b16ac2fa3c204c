// SPDX-License-Identifier: GPL-3.0-or-later
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "mesh/same_position.h"
#include "mesh/surface_point.h"
#include "mesh/triangle_edges.h"
#include "shapes.h"

namespace kiln {
namespace test_mesh_edges {

TEST(SamePosition, IsTheFirstOne) {
  const std::vector<Eigen::Vector3f> positions = {{0, 1, 2}, {3, 4, 5}, {-0.f, 1, 2}, {3, 4, 5}, {3, 4, 6}, {0, 1, 2}};
  const std::vector<std::uint32_t> first = first_at_position(positions);
  EXPECT_EQ(first, (std::vector<std::uint32_t>{0, 1, 0, 1, 4, 0}));
  std::uint32_t count = 0;
  EXPECT_EQ(without_gaps(first, &count), (std::vector<std::uint32_t>{0, 1, 0, 1, 2, 0}));
  EXPECT_EQ(count, 3u);
  EXPECT_TRUE(first_at_position(std::vector<Eigen::Vector3f>{}).empty());
}

TEST(SamePosition, OfDoublesTellsApartWhatFloatsDoNot) {
  const double next = std::nextafter(1.0, 2.0);
  const std::vector<Eigen::Vector3d> positions = {{1, 0, 0}, {next, 0, 0}, {1, -0.0, 0}};
  EXPECT_EQ(first_at_position(positions), (std::vector<std::uint32_t>{0, 1, 0}));
}

/// Ends, though values that are not numbers equal nothing by comparison.
TEST(SamePosition, TakesWhatIsNoNumber) {
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(first_of_equals(std::vector<float>(20'000, nan), 2), std::vector<std::uint32_t>(10'000, 0));
}

TEST(SamePosition, AgreesWithComparingAll) {
  std::mt19937 random(5);
  std::vector<float> values;
  for (int k = 0; k < 4 * 500; ++k) values.push_back(static_cast<float>(random() % 4) - 2);
  const std::vector<std::uint32_t> first = first_of_equals(values, 4);
  for (std::size_t i = 0; i < first.size(); ++i) {
    std::size_t wanted = 0;
    while (!std::equal(&values[4 * wanted], &values[4 * wanted] + 4, &values[4 * i])) ++wanted;
    EXPECT_EQ(first[i], wanted);
  }
}

TEST(TriangleEdges, ListEverySideOnceInOrder) {
  TriangleMesh mesh = shapes::torus(12);
  std::shuffle(mesh.triangles.begin(), mesh.triangles.end(), std::mt19937(3));
  mesh.triangles.push_back(mesh.triangles[0]);  // three and four sides at some edges
  mesh.triangles.push_back({1, 1, 2});          // a side from a vertex to itself
  std::map<EdgeKey, std::vector<std::uint32_t>> wanted;
  for (std::uint32_t corner = 0; corner < 3 * mesh.triangles.size(); ++corner)
    wanted[edge_at(mesh.triangles, corner)].push_back(corner);
  auto next = wanted.begin();
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    ASSERT_NE(next, wanted.end());
    EXPECT_EQ(std::vector<std::uint32_t>(sides.begin(), sides.end()), next->second);
    ++next;
  });
  EXPECT_EQ(next, wanted.end());
  TriangleEdges(std::vector<Triangle>{}).for_each([](auto) { FAIL() << "an edge of no triangles"; });
}

TEST(TriangleEdges, OfACubeWeldedAtItsCorners) {
  TriangleMesh split;  // each triangle has vertices of its own
  const TriangleMesh cube = shapes::cube(1);
  for (const Triangle& t : cube.triangles) {
    const auto next = static_cast<std::uint32_t>(split.positions.size());
    for (const std::uint32_t vertex : t) split.positions.push_back(cube.positions[vertex]);
    split.triangles.push_back({next, next + 1, next + 2});
  }
  EXPECT_FALSE(is_closed(split));
  const TriangleMesh whole = join_at_positions(split);
  EXPECT_TRUE(is_closed(whole));
  EXPECT_EQ(whole.positions.size(), 8u);
  int edges = 0;
  TriangleEdges(whole.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    ++edges;
    ASSERT_EQ(sides.size(), 2u);
    EXPECT_TRUE(run_opposite(whole.triangles, sides[0], sides[1]));
  });
  EXPECT_EQ(edges, 18) << "twelve, and a diagonal in each square";
}

TEST(BoundingBoxes, GrowAroundPointsAndBoxes) {
  BoundingBox box;
  EXPECT_TRUE(box.is_empty());
  EXPECT_EQ(box.diagonal(), 0);
  box.extend({1, 2, 3});
  EXPECT_FALSE(box.is_empty());
  EXPECT_EQ(box.diagonal(), 0);
  BoundingBox other = bounding_box(std::vector<Eigen::Vector3f>{{0, 0, 0}, {-2, 4, 1}});
  box.merge(other);
  EXPECT_EQ(box.lowest, Eigen::Vector3f(-2, 0, 0));
  EXPECT_EQ(box.highest, Eigen::Vector3f(1, 4, 3));
  EXPECT_TRUE(box.contains({0, 4, 3}));
  EXPECT_FALSE(box.contains({0, 4.001f, 3}));
  box.merge({});
  EXPECT_EQ(box.sides(), Eigen::Vector3f(3, 4, 3));
}

TEST(SurfacePoints, InterpolateBetweenCorners) {
  TriangleMesh mesh;
  mesh.positions = {{0, 0, 0}, {4, 0, 0}, {0, 0, -4}};
  mesh.normals = {{0, 1, 0}, {0, 1, 0}, {0, 1, 0}};
  mesh.triangles = {{0, 1, 2}};
  const SurfacePoint point{0, 0.25f, 0.5f, 0};
  EXPECT_EQ(position_at(mesh, point), Eigen::Vector3f(1, 0, -2));
  EXPECT_EQ(normal_at(mesh, point), Eigen::Vector3f::UnitY());
  EXPECT_EQ(interpolate(mesh, std::vector<float>{8, 4, 2}, point), 4);  // 2 + 1 + 1
  mesh.normals[1] = mesh.normals[2] = {0, -1, 0};
  EXPECT_EQ(normal_at(mesh, {0, 0.25f, 0.25f, 0}), Eigen::Vector3f::UnitY()) << "they cancel: the triangle's own";
}

}  // namespace test_mesh_edges
}  // namespace kiln
