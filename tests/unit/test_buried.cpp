// SPDX-License-Identifier: GPL-3.0-or-later
// Points inside other parts of a mesh, against solids whose inside is known, and texels that are buried there.
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <malloc.h>

#include "bake/planes/coefficient_planes.h"
#include "bake/scene/buried_receivers.h"
#include "bake/scene/occluders.h"
#include "bake/scene/receiver_set.h"
#include "base/parallel.h"
#include "image/gutter.h"
#include "maps/footprint.h"
#include "raycast/buried_test.h"
#include "raycast/ray_transfer.h"
#include "sh/directions.h"
#include "sh/ray_offset.h"
#include "shapes.h"

namespace kiln {
namespace test_buried {

struct Points {
  std::vector<Eigen::Vector3f> positions, normals;
  Receivers view() const { return {positions, normals}; }
};

/// Spreads `count` points over the triangles from `first` to `last`, with the triangles' normals.
Points points_on(const TriangleMesh& mesh, std::size_t first, std::size_t last, std::size_t count) {
  Points points;
  for (std::size_t k = 0; k < count; ++k) {
    const Triangle& t = mesh.triangles[first + k * 7919 % (last - first)];
    const float u = static_cast<float>(k * 37 % 101) / 101, v = (1 - u) * static_cast<float>(k * 53 % 97) / 97;
    const Eigen::Vector3f &a = mesh.positions[t[0]], &b = mesh.positions[t[1]], &c = mesh.positions[t[2]];
    points.positions.push_back((1 - u - v) * a + u * b + v * c);
    points.normals.push_back((b - a).cross(c - a).normalized());
  }
  return points;
}

std::vector<std::uint8_t> buried(const TriangleMesh& mesh, const Points& points) {
  return BuriedTest(mesh.positions, mesh.triangles, rounding_offset(mesh.positions))(points.view());
}

std::size_t count_buried(const TriangleMesh& mesh, const Points& points) {
  const std::vector<std::uint8_t> marks = buried(mesh, points);
  return static_cast<std::size_t>(std::count(marks.begin(), marks.end(), 1));
}

/// Joins the triangles of both meshes, the second ones turned inside out.
TriangleMesh turned(TriangleMesh mesh) {
  for (Triangle& t : mesh.triangles) std::swap(t[1], t[2]);
  return mesh;
}

TriangleMesh scaled(TriangleMesh mesh, const Eigen::Vector3f& by) {
  for (Eigen::Vector3f& p : mesh.positions) p = p.cwiseProduct(by);
  return mesh;
}

TEST(Buried, ASphereThroughABoxIsBuriedWhereItIsInside) {
  const TriangleMesh sphere = shapes::icosphere(4, 0.6f);
  for (const Eigen::Vector3f& move : {Eigen::Vector3f(0, 0, 0), Eigen::Vector3f(0.3f, 0.1f, -0.2f)}) {
    const TriangleMesh mesh = shapes::joined(sphere, shapes::cube(3), move);
    const Points points = points_on(mesh, 0, sphere.triangles.size(), 20000);
    const std::vector<std::uint8_t> marks = buried(mesh, points);
    std::size_t inside = 0, near_the_line = 0;
    for (std::size_t k = 0; k < marks.size(); ++k) {
      const float depth = 0.5f - (points.positions[k] - move).cwiseAbs().maxCoeff();  // below the box's surface
      inside += depth > 0 ? 1 : 0;
      near_the_line += std::abs(depth) < 1e-3f ? 1 : 0;
      // Exact but for the offset of rays, a few millionths.
      if (std::abs(depth) > 1e-5f) {
        ASSERT_EQ(marks[k] != 0, depth > 0) << depth;
      }
    }
    EXPECT_GT(inside, 1000u);
    EXPECT_GT(near_the_line, 20u);
  }
}

TEST(Buried, NothingIsWherePartsOnlyStandBesideEachOther) {
  const TriangleMesh pair = shapes::joined(shapes::cube(3), shapes::icosphere(3, 0.5f), {1.1f, 0, 0});
  EXPECT_EQ(count_buried(pair, points_on(pair, 0, pair.triangles.size(), 5000)), 0u);
  const TriangleMesh torus = shapes::torus(24);
  EXPECT_EQ(count_buried(torus, points_on(torus, 0, torus.triangles.size(), 5000)), 0u);
}

TEST(Buried, FurnitureInARoomIsNot) {
  const TriangleMesh room = turned(scaled(shapes::cube(2), {4, 4, 4})), box = shapes::cube(2);
  const TriangleMesh mesh = shapes::joined(box, room, {0, 0, 0});
  EXPECT_EQ(count_buried(mesh, points_on(mesh, 0, mesh.triangles.size(), 3000)), 0u);
  // A box in a box in that room is buried.
  const TriangleMesh nested = shapes::joined(scaled(box, {0.5f, 0.5f, 0.5f}), mesh, {0, 0, 0});
  EXPECT_EQ(count_buried(nested, points_on(nested, 0, box.triangles.size(), 1000)), 1000u);
}

TEST(Buried, APartThatRunsIntoItselfIsWhereItDoes) {
  // The inner side of a torus whose tube is thicker than its ring is inside itself.
  const TriangleMesh spindle = shapes::torus(48, 0.5f, 0.8f);
  const Points points = points_on(spindle, 0, spindle.triangles.size(), 20000);
  const std::vector<std::uint8_t> marks = buried(spindle, points);
  std::size_t inside = 0;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    // Inside the tube of the other side: closer to its ring than 0.8; the facets' errors add up to less than 0.02.
    const Eigen::Vector3f& p = points.positions[k];
    const Eigen::Vector2f across(p.x(), p.z());
    const float other = Eigen::Vector2f(across.norm() + 0.5f, p.y()).norm();
    if (std::abs(other - 0.8f) > 0.02f) {
      EXPECT_EQ(marks[k] != 0, other < 0.8f) << p.transpose();
    }
    inside += marks[k];
  }
  EXPECT_GT(inside, 100u);
}

TEST(Buried, UnderASkirtIsDarkNotBuriedAndInAHeadIsBuried) {
  // Spheres of one sheet, open below: by a wide hole, and by a small one.
  const auto open_sphere = [](float lowest) {
    TriangleMesh mesh = shapes::icosphere(4);
    std::erase_if(mesh.triangles, [&](const Triangle& t) {
      return std::max({mesh.positions[t[0]].y(), mesh.positions[t[1]].y(), mesh.positions[t[2]].y()}) < lowest;
    });
    return mesh;
  };
  const TriangleMesh small = scaled(shapes::cube(4), {0.2f, 0.2f, 0.2f});
  const TriangleMesh skirt = shapes::joined(small, open_sphere(-0.3f), {0, 0.2f, 0});
  EXPECT_LT(count_buried(skirt, points_on(skirt, 0, small.triangles.size(), 1000)),
            200u);  // its top alone sees nothing
  const TriangleMesh head = shapes::joined(small, open_sphere(-0.98f), {0, -0.3f, 0});
  // The bottom sees light through the neck.
  EXPECT_GE(count_buried(head, points_on(head, 0, small.triangles.size(), 1000)), 830u);
}

TEST(Buried, UnderLeavesThatOpacityCutsNothingIs) {
  // Leaves bent around a twig hide it from all light with their backs, as the inside of a head does.
  TriangleMesh leaves = shapes::icosphere(3, 1);
  std::erase_if(leaves.triangles, [&](const Triangle& t) { return leaves.positions[t[0]].y() < -0.6f; });
  const Points twig{{{0, 0, 0}}, {Eigen::Vector3f(0.6f, 0.8f, 0)}};
  Occluders occluders = join_occluders({leaves});
  const auto is_buried = [&] {
    return BuriedTest(occluders.mesh.positions, enclosing_triangles(occluders), 1e-5f)(twig.view())[0];
  };
  EXPECT_EQ(is_buried(), 1);
  occluders.sheets.assign(leaves.triangles.size(), 1);
  EXPECT_EQ(is_buried(), 0);
}

TEST(Buried, SameForAnyThreads) {
  const TriangleMesh mesh = shapes::joined(shapes::icosphere(4, 0.6f), shapes::cube(3), {0.1f, 0.2f, 0});
  const Points points = points_on(mesh, 0, mesh.triangles.size(), 5000);
  const auto marks = [&](int threads) {
    const ThreadLimit limit(static_cast<std::size_t>(threads));
    return buried(mesh, points);
  };
  EXPECT_EQ(marks(1), marks(4));
}

/// Makes a floor with uvs, and a closed block that stands in it, turned so that its edges cross texels at all angles.
/// The block's own uvs cover nothing.
struct Stage {
  TriangleMesh mesh;
  Occluders occluders;
  std::size_t floor_triangles = 0;
  float ray_offset = 0;

  Stage() {
    const TriangleMesh floor = shapes::plane(8);
    TriangleMesh block = scaled(shapes::cube(6), {0.4f, 0.3f, 0.2f});
    const Eigen::AngleAxisf turn(0.4f, Eigen::Vector3f::UnitY());
    for (Eigen::Vector3f& p : block.positions) p = turn * p;
    mesh = shapes::joined(floor, block, {0.03f, 0.02f, -0.05f});
    mesh.normals.assign(mesh.positions.size(), Eigen::Vector3f::UnitY());
    mesh.uvs = floor.uvs;
    mesh.uvs.resize(mesh.positions.size(), Eigen::Vector2f(0.01f, 0.01f));
    floor_triangles = floor.triangles.size();
    occluders = join_occluders({mesh});
    ray_offset = rounding_offset(mesh.positions);
  }

  /// Computes t_0 of points.
  std::vector<float> openness(const Receivers& points) const {
    const RayScene scene(occluders.mesh);
    const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 1024, 1);
    return transfer_by_rays(scene, points, directions, 1, ray_offset).values;
  }

  /// Finds the most negative error of lookups, at visible points of the floor, in a plane baked for `receivers`.
  float darkest_difference(const ReceiverSet& receivers) const {
    Image<float> plane(receivers.width, receivers.height, 1);
    const std::vector<float> values = openness(receivers.view());
    for (std::size_t r = 0; r < values.size(); ++r) plane.values()[receivers.slots[r]] = values[r];
    receivers.fills.apply(plane.values());
    std::vector<std::uint8_t> filled = receivers.covered();
    for (const FillPlan::Texel& fill : receivers.fills.texels) filled[fill.texel] = 1;
    fill_gutters(plane, filled);

    const Points points = points_on(mesh, 0, floor_triangles, 20000);
    const std::vector<std::uint8_t> hidden = buried(mesh, points);
    const std::vector<float> truth = openness(points.view());
    float darkest = 0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      if (hidden[k] != 0) continue;
      const Eigen::Vector3f& p = points.positions[k];
      const Eigen::Vector2f uv(0.1f + 0.8f * (p.x() + 0.5f), 0.1f + 0.8f * (0.5f - p.z()));
      const auto shown = static_cast<float>(Footprint(uv, receivers.width, receivers.height).lookup(plane, 0));
      darkest = std::min(darkest, shown - truth[k]);
    }
    return darkest;
  }
};

TEST(Buried, NothingBlackBleedsOntoTheFloorBesideABlock) {
  const Stage stage;
  ReceiverSet receivers = receivers_on_low(stage.mesh, 64, 64, nullptr);
  const std::size_t covered = receivers.slots.size();
  // Without the treatment, texels beneath the block are black, and lookups beside it see half of that.
  EXPECT_LT(stage.darkest_difference(receivers), -0.1f);

  const BuriedReport report = set_aside_buried(receivers, stage.mesh, stage.occluders, stage.ray_offset);
  EXPECT_FALSE(report.everything);
  EXPECT_GT(report.moved, 20u);
  EXPECT_EQ(receivers.slots.size() + report.buried, covered);
  EXPECT_EQ(receivers.fills.texels.size(), report.buried);
  // The block's footprint in texels of (1 / 0.8 / 64)^2, less those on its outline.
  const double footprint = 0.4 * 0.2 * 0.8 * 0.8 * 64 * 64;
  EXPECT_LT(static_cast<double>(report.buried), footprint);
  EXPECT_GT(static_cast<double>(report.buried), 0.6 * footprint);
  // At the foot of a wall of height h the truth falls by 0.14 / h towards it: by 0.016 from texel to texel, and faster
  // about the wall's corners. Lookups between two texels are off by up to two steps there.
  EXPECT_GT(stage.darkest_difference(receivers), -0.032f);
}

TEST(Buried, FillsAreMeansOfNeighboursInTheirChartAlone) {
  const Stage stage;
  ReceiverSet receivers = receivers_on_low(stage.mesh, 64, 64, nullptr);
  set_aside_buried(receivers, stage.mesh, stage.occluders, stage.ray_offset);
  std::vector<float> plane(64 * 64, -1000.f);  // whatever is not filled would show
  for (const std::uint32_t texel : receivers.slots) plane[texel] = static_cast<float>(texel % 64);
  receivers.fills.apply(plane);
  for (const FillPlan::Texel& fill : receivers.fills.texels) {
    EXPECT_GE(plane[fill.texel], 0);
    EXPECT_LE(plane[fill.texel], 63);
  }
}

TEST(Buried, NoRayStartsWhereNoOtherPlaceOfATexelWasFound) {
  // glibc fills memory that it hands out with 0x7f, floats beyond what Embree takes: it ended the bake of a torus of 50
  // triangles in an atlas of 32 x 32.
  const Stage stage;
  ReceiverSet receivers = receivers_on_low(stage.mesh, 16, 16, nullptr);
  mallopt(M_PERTURB, 0x80);
  const BuriedReport report = set_aside_buried(receivers, stage.mesh, stage.occluders, stage.ray_offset);
  mallopt(M_PERTURB, 0);
  EXPECT_GT(report.buried, 0u);
  for (const Eigen::Vector3f& position : receivers.positions) EXPECT_LT(position.norm(), 1);
}

TEST(Buried, WhatIsInsideAsAWholeIsKept) {
  const TriangleMesh floor = shapes::plane(4);
  TriangleMesh mesh = shapes::joined(floor, scaled(shapes::cube(2), {3, 3, 3}), {0, 0, 0});
  mesh.normals.assign(mesh.positions.size(), Eigen::Vector3f::UnitY());
  mesh.uvs = floor.uvs;
  mesh.uvs.resize(mesh.positions.size(), Eigen::Vector2f(0.01f, 0.01f));
  ReceiverSet receivers = receivers_on_low(mesh, 32, 32, nullptr);
  const std::size_t covered = receivers.slots.size();
  const BuriedReport report =
      set_aside_buried(receivers, mesh, join_occluders({mesh}), rounding_offset(mesh.positions));
  EXPECT_TRUE(report.everything);
  EXPECT_EQ(receivers.slots.size(), covered);
}

TEST(Buried, VerticesAreFilledAlongEdges) {
  const Stage stage;
  ReceiverSet receivers{static_cast<int>(stage.mesh.positions.size()), 1, {}, {}, {}};
  const std::size_t floor_vertices = 81;
  for (std::uint32_t v = 0; v < floor_vertices; ++v) {
    receivers.slots.push_back(v);
    receivers.positions.push_back(stage.mesh.positions[v]);
    receivers.normals.push_back(Eigen::Vector3f::UnitY());
  }
  const BuriedReport report = set_aside_buried_vertices(receivers, stage.mesh, stage.occluders, stage.ray_offset);
  EXPECT_GT(report.buried, 0u);
  EXPECT_EQ(receivers.slots.size(), floor_vertices - report.buried);
  ASSERT_EQ(receivers.fills.texels.size(), report.buried);
  std::vector<float> plane(stage.mesh.positions.size(), 0.f);
  for (std::uint32_t v : receivers.slots) plane[v] = 1;
  receivers.fills.apply(plane);
  for (std::size_t v = 0; v < floor_vertices; ++v) EXPECT_FLOAT_EQ(plane[v], 1);
}

}  // namespace test_buried
}  // namespace kiln
