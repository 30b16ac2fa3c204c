// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "runtime/shadow/blocked_directions.h"
#include "runtime/shadow/direction_sums.h"
#include "runtime/shadow/occluder_outline.h"
#include "shadow_scenes.h"

namespace kiln {
namespace test_shadow_work {

/// A low box that is open above, with flat parts, and a ball in it: what outlines decide, and what they leave to rays.
TriangleMesh room() {
  TriangleMesh floor = shapes::plane(6, 4, -0.5f), ball = shapes::icosphere(2, 0.4f);
  return shapes::joined(shapes::joined(shapes::cube(3), floor, {0, -1, 0}), ball, {1.2f, 0.3f, 0});
}

/// Compares what is blocked with single rays, for points within, before and beside the mesh.
TEST(BlockedDirections, AreThoseThatSingleRaysFind) {
  for (const TriangleMesh& mesh : {room(), shapes::cube(2), shapes::icosphere(2), shapes::plane(4, 3)}) {
    const RayOccluder occluder(mesh);
    Placement pose = placed_at(0.3, -0.2, 0.1, 1.7);
    pose.rotation = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
    const BoundingBall own = bounding_ball(mesh), ball{pose.to_scene(own.centre), pose.scale * own.radius};
    const DirectionSet set = sphere_directions(2000, 0);
    std::mt19937 generator(5);
    std::uniform_real_distribution<double> uniform(-3, 3);
    BlockedDirections state;
    int wrong = 0, hit = 0;
    for (int k = 0; k < 24; ++k) {
      const Eigen::Vector3d point(uniform(generator), uniform(generator), uniform(generator));
      state.reset(set, std::nullopt, 0);
      state.block(occluder, pose, ball, point, {});
      state.finish();
      for (std::uint32_t d = 0; d < set.count(); ++d) {
        const bool is_hit = occluder.blocks(pose, point, set.direction(d).cast<double>(), 1e9f);
        hit += is_hit ? 1 : 0;
        wrong += is_hit != (state.blocked()[d] != 0) ? 1 : 0;
      }
    }
    EXPECT_GT(hit, 1000);
    EXPECT_LE(wrong, 2);  // of 48,000: directions through an edge, to rounding
  }
}

TEST(BlockedDirections, FarBelowTheHorizonOneStandsForEight) {
  const TriangleMesh mesh = shapes::plane(2, 4);
  const RayOccluder occluder(mesh);
  const BoundingBall ball = bounding_ball(mesh);
  const DirectionSet set = sphere_directions(1024, 0);
  BlockedDirections all, few;
  const Eigen::Vector3d point(0.3, 0.4, 0.1), up(0, 1, 0);
  all.reset(set, std::nullopt, 0);
  few.reset(set, up, -0.35f);
  for (BlockedDirections* state : {&all, &few}) {
    state->block(occluder, {}, ball, point, {});
    state->finish();
  }
  int differing = 0;
  for (std::uint32_t d = 0; d < set.count(); ++d) {
    if (all.blocked()[d] == few.blocked()[d]) continue;
    ++differing;
    EXPECT_LT(set.y[d], -0.35f);
  }
  EXPECT_LT(differing, 60);
}

TEST(OccluderOutline, FindsTheSidesOfACubeAndNoneOfABall) {
  EXPECT_EQ(outline_of(shapes::cube(4)).flats.size(), 6u);
  EXPECT_EQ(outline_of(shapes::cube(4)).boxes.size(), 0u);
  EXPECT_EQ(outline_of(shapes::icosphere(2)).flats.size(), 0u);
  EXPECT_EQ(outline_of(shapes::icosphere(2)).boxes.size(), 1u);
  // A hole in the middle of a sheet is none of a flat part.
  TriangleMesh sheet = shapes::plane(4, 4);
  std::erase_if(sheet.triangles, [&](const Triangle& corners) {
    const Eigen::Vector3f middle =
        (sheet.positions[corners[0]] + sheet.positions[corners[1]] + sheet.positions[corners[2]]) / 3;
    return middle.x() > -1 && middle.x() < 0 && middle.z() > -1 && middle.z() < 0;
  });
  EXPECT_TRUE(outline_of(sheet).flats.empty());
}

TEST(DirectionSums, AddWhatAPlainLoopAdds) {
  constexpr std::size_t width = 25, count = 333;
  std::mt19937 generator(3);
  std::uniform_real_distribution<float> uniform;
  std::vector<float> rows(width * count);
  for (float& value : rows) value = uniform(generator);
  const DirectionSums sums(rows, width);
  for (const float share : {0.f, 0.1f, 0.9f, 1.f}) {
    std::vector<std::uint8_t> taken(count);
    for (std::size_t d = 0; d < count; ++d) taken[d] = d < 100 || uniform(generator) < share ? 1 : 0;
    std::vector<float> sum(width);
    sums.add_up(taken, sum);
    for (std::size_t i = 0; i < width; ++i) {
      double wanted = 0;
      for (std::size_t d = 0; d < count; ++d) wanted += taken[d] != 0 ? static_cast<double>(rows[d * width + i]) : 0;
      EXPECT_NEAR(static_cast<double>(sum[i]), wanted, 1e-4);
    }
  }
}

/// A ground with light at its vertices, static, and three balls above it.
struct GroundScene {
  TriangleMesh ground = shapes::plane(24, 12), ball = shapes::icosphere(2, 0.5f);
  SceneTree tree = make_tree({{0, 0, true}, {0, 1}, {0, 1}, {0, 1}});
  ScenePoses poses = {Placement{}, Placement{}, placed_at(-3, 1.2, 0), placed_at(3, 1.5, 1), placed_at(0, 2.5, -3)};

  std::vector<ShadowObject> objects() const {
    return {{&ground, ground.positions, 4, ground.normals}, {&ball, {Eigen::Vector3f::Zero()}, 4, {}}};
  }
  MovingShadows shadows() const {
    ShadowSettings settings;
    settings.directions = 200;
    return MovingShadows(tree, objects(), settings);
  }
};

TEST(MovingShadows, AMoverCostsOnlyThePointsThatMaySeeIt) {
  GroundScene scene;
  const SceneLights lights{{light_from_above(10)}, std::nullopt, LightWindow::none};
  MovingShadows shadows = scene.shadows();
  shadows.update(scene.poses, lights);
  const std::size_t all = shadows.statistics().computed;
  EXPECT_EQ(all, scene.ground.positions.size() + 3);
  scene.poses[2].translation.x() += 0.25;
  shadows.update(scene.poses, lights);
  // The shadow's old and new place: about 2.2 by 2 of the ground's 12 by 12.
  EXPECT_GT(shadows.statistics().computed, 2u);
  EXPECT_LT(shadows.statistics().computed, all / 8);
  EXPECT_EQ(shadows.statistics().computed + shadows.statistics().kept, all);
  MovingShadows fresh = scene.shadows();
  fresh.update(scene.poses, lights);
  for (std::size_t p = 0; p < scene.ground.positions.size(); ++p)
    ASSERT_EQ(shadows.light_of(1)[p].channels, fresh.light_of(1)[p].channels);
  // A ball under the ground is under its horizon: only the other balls may see it.
  scene.poses[4].translation = {0, -6, 0};
  shadows.update(scene.poses, lights);
  scene.poses[4].translation = {1, -6, 0};
  shadows.update(scene.poses, {{ambient_light()}, std::nullopt, LightWindow::none});
  scene.poses[4].translation = {0, -6, 0};
  shadows.update(scene.poses, {{ambient_light()}, std::nullopt, LightWindow::none});
  EXPECT_LE(shadows.statistics().computed, 3u);
}

/// Things start and stop, turn and leave; what is kept of those that stand still never shows.
TEST(MovingShadows, WhatIsKeptOfStillOccludersIsWhatANewComputationFinds) {
  GroundScene scene;
  const SceneLights lights{{light_from_above(20), ambient_light()}, std::nullopt, LightWindow::none};
  MovingShadows shadows = scene.shadows();
  std::mt19937 generator(2);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int step = 0; step < 16; ++step) {
    for (std::size_t node = 2; node < 5; ++node)
      if (uniform(generator) > 0.2) {
        scene.poses[node].translation += 0.5 * Eigen::Vector3d(uniform(generator), 0, uniform(generator));
        if (step % 5 == 4) scene.poses[node].translation.y() *= -1;
      }
    shadows.update(scene.poses, lights);
    MovingShadows fresh = scene.shadows();
    fresh.update(scene.poses, lights);
    for (const int node : {1, 2, 3, 4})
      for (std::size_t p = 0; p < shadows.light_of(node).size(); ++p)
        ASSERT_EQ(shadows.light_of(node)[p].channels, fresh.light_of(node)[p].channels) << step << " " << node;
  }
}

/// Other groups of the same nodes: nothing is computed again where nothing moved, but the light of filters that come
/// down another way.
TEST(MovingShadows, AnotherTreeOfTheSameNodesKeepsWhatHolds) {
  const TriangleMesh ball = shapes::icosphere(2);
  const std::vector<ShadowObject> objects = {{&ball, {Eigen::Vector3f::Zero()}, 4, {}}};
  const SceneLights lights{{light_from_above(30)}, std::nullopt, LightWindow::none};
  // Nodes a to d: first two pairs, then a pair, and two that stand alone, in another order.
  SceneTree pairs = make_tree({{0, -1}, {1, 0}, {1, 0}, {0, -1}, {4, 0}, {4, 0}}),
            other = make_tree({{0, 0}, {0, -1}, {2, 0}, {2, 0}, {0, 0}});
  const auto name = [](SceneTree& tree, std::vector<std::string> names) {
    for (std::size_t k = 0; k < names.size(); ++k) tree.nodes[k + 1].name = names[k];
  };
  name(pairs, {"ab", "a", "b", "cd", "c", "d"});
  name(other, {"d", "around a", "b", "a", "c"});
  const Placement a = placed_at(0, 0, 0), b = placed_at(0.4, 3, 0), c = placed_at(7, 0, 0), d = placed_at(7, 3, 0.5);
  for (const ShadowMethod method : {ShadowMethod::combined, ShadowMethod::thesis, ShadowMethod::fields}) {
    ShadowSettings settings;
    settings.method = method;
    settings.directions = 500;
    MovingShadows shadows(pairs, objects, settings), fresh(other, objects, settings);
    shadows.update({{}, {}, a, b, {}, c, d}, lights);
    shadows.set_tree(other);
    const ScenePoses now = {{}, d, {}, b, a, c};
    shadows.update(now, lights);
    // By filters only the pair that came apart, whose siblings are others now, and the pair that stayed, by its ball.
    EXPECT_LE(shadows.statistics().computed, method == ShadowMethod::thesis   ? 3u
                                             : method == ShadowMethod::fields ? 4u
                                                                              : 0u);
    fresh.update(now, lights);
    for (const int node : {1, 3, 4, 5})
      for (std::size_t i = 0; i < 16; ++i)
        EXPECT_NEAR(shadows.light_of(node)[0].channels[0][i], fresh.light_of(node)[0].channels[0][i], 1e-5);
    if (method != ShadowMethod::combined) continue;
    // A node that is gone takes its shadow with it.
    SceneTree fewer = make_tree({{0, 0}, {0, 0}, {0, 0}});
    name(fewer, {"a", "c", "d"});
    shadows.set_tree(fewer);
    shadows.update({{}, a, c, d}, lights);
    EXPECT_EQ(shadows.statistics().computed, 1u);
    EXPECT_EQ(shadows.light_of(1)[0].channels, light_asset(lights, 4, a, objects[0].points).samples[0].channels);
  }
}

}  // namespace test_shadow_work
}  // namespace kiln
