// SPDX-License-Identifier: GPL-3.0-or-later
#include <epoxy/gl.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <gtest/gtest.h>
#include <memory>
#include <numbers>
#include <random>

#include "base/errors.h"
#include "gpu/egl_context.h"
#include "runtime/shadow_gl/map_views.h"
#include "runtime/shadow_gl/visibility_maps.h"
#include "shadow_scenes.h"

namespace kiln {
namespace test_shadow_maps_gl {

constexpr double pi = std::numbers::pi;

SceneLights lights_of(std::vector<LightSpec> specs) { return {std::move(specs), std::nullopt, LightWindow::none}; }

LightSpec lamp_at(double x, double y, double z, double radius) {
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  lamp.position = {x, y, z};
  lamp.radius = radius;
  return lamp;
}

LightSpec cone_from(double azimuth, double elevation, double half_angle) {
  LightSpec light = light_from_above(half_angle);
  light.azimuth_degrees = azimuth;
  light.elevation_degrees = elevation;
  return light;
}

/// The same scene by rays and by maps.
struct BothWays {
  const EglContext context{"software"};
  ShadowSettings settings;
  std::shared_ptr<VisibilityMaps> maps;

  explicit BothWays(const VisibilityMapSettings& of_maps = {}) : maps(std::make_shared<VisibilityMaps>(of_maps)) {}

  MovingShadows by(const SceneTree& tree, const std::vector<ShadowObject>& objects, bool by_maps) const {
    return MovingShadows(tree, objects, settings, by_maps ? maps : nullptr);
  }

  /// Returns the largest difference of a node's coefficients, as a share of the light without shadows, and expects that
  /// rays find at least `least` of it blocked somewhere.
  double difference(const SceneTree& tree, const std::vector<ShadowObject>& objects, const ScenePoses& poses,
                    const SceneLights& lights, double least = 0.01, int node = 1) const {
    MovingShadows rays = by(tree, objects, false), drawn = by(tree, objects, true);
    rays.update(poses, lights);
    drawn.update(poses, lights);
    const auto& object = objects[static_cast<std::size_t>(tree.nodes[static_cast<std::size_t>(node)].asset)];
    const AssetLight open = light_asset(lights, object.bands, poses[static_cast<std::size_t>(node)], object.points);
    double largest = 0, taken = 0;
    for (std::size_t p = 0; p < object.points.size(); ++p) {
      const double whole = length_of(open.samples[p]);
      largest = std::max(largest, largest_difference(rays.light_of(node)[p], drawn.light_of(node)[p]) / whole);
      taken = std::max(taken, largest_difference(rays.light_of(node)[p], open.samples[p]) / whole);
    }
    EXPECT_GE(taken, least);
    return largest;
  }
};

/// Whatever direction in a pyramid meets a ball, the pyramid may see the ball; and a ball far beside it is not seen.
TEST(MapView, SeesEveryBallThatADirectionOfItMeets) {
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  int unseen = 0;
  for (int k = 0; k < 4000; ++k) {
    const Eigen::Vector3d axis = Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator));
    const MapView view =
        k % 2 == 0 ? view_of_face(k / 2 % 6) : view_of_cone(axis.normalized(), 0.3 + 0.4 * uniform(generator));
    EXPECT_NEAR(view.right.dot(view.axis) + view.up.dot(view.axis) + view.right.dot(view.up), 0, 1e-12);
    const Eigen::Vector3d direction =
        view.axis + view.half_width * (uniform(generator) * view.right + uniform(generator) * view.up);
    const double radius = 0.5 + 0.4 * uniform(generator);
    const Eigen::Vector3d aside(uniform(generator), uniform(generator), uniform(generator));
    const Eigen::Vector3d on_ray = (1.1 + uniform(generator)) * direction;
    EXPECT_TRUE(view.may_see({on_ray + 0.999 * radius * aside / std::max(1.0, aside.norm()), radius}));
    unseen +=
        view.may_see({3 * Eigen::Vector3d(uniform(generator), uniform(generator), uniform(generator)), 0.1}) ? 0 : 1;
  }
  EXPECT_GT(unseen, 2000);
}

/// Two balls under lights of every kind: the same quantity, up to the texels of the maps.
TEST(VisibilityMaps, TwoBallsAgreeWithRays) {
  const BothWays ways;
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {{0, 0, 0}, {0, 1, 0}, {0.6f, 0.8f, 0}, {-1, 0, 0}}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  Placement own = placed_at(0.2, -0.1, 0.3, 0.7);
  own.rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const ScenePoses poses = {Placement{}, own, placed_at(0.3, 2.4, 0.1)};
  LightSpec half = light_from_above(0);
  half.kind = LightSpec::Kind::hemisphere;
  half.color = {1, 0.5f, 0.2f};
  half.ground = {0.1f, 0.2f, 0.3f};
  const std::vector<std::pair<LightSpec, double>> cases = {
      {light_from_above(6), 0.01},      {cone_from(20, 75, 12), 0.01},
      {cone_from(200, 60, 30), 0.01},   {cone_from(0, 80, 60), 0.01},
      {lamp_at(0.4, 20, 0.2, 3), 0.01}, {lamp_at(0.3, 9, 0, 6), 0.01},
      {ambient_light(), 0.01},          {half, 0.01},
      {light_from_above(0), 1e-6},      {lamp_at(0, 5000, 0, 1), 1e-6}};
  for (const auto& [light, bound] : cases)
    EXPECT_LT(ways.difference(tree, objects, poses, lights_of({light})), bound)
        << static_cast<int>(light.kind) << " " << light.half_angle_degrees << " " << light.radius;
}

TEST(VisibilityMaps, WithoutOccluderNothingChangesToTheBit) {
  const BothWays ways;
  const TriangleMesh ball = shapes::icosphere(2);
  const std::vector<ShadowObject> objects = {{&ball, ball.positions, 5, ball.normals}};
  const SceneTree alone = make_tree({{0, 0}}), beside = make_tree({{0, 0}, {0, 0}, {0, 0, true}, {0, 0, true}});
  const SceneLights lights = lights_of({light_from_above(12), lamp_at(4, 30, 2, 1), light_from_above(0)});
  for (const SceneTree* tree : {&alone, &beside}) {
    MovingShadows shadows = ways.by(*tree, objects, true);
    ScenePoses poses = {Placement{}, placed_at(1, 2, 3, 0.7), placed_at(20, 0, 0), placed_at(30, -5, 0),
                        placed_at(30, 5, 0)};
    poses.resize(tree->nodes.size());
    shadows.update(poses, lights);
    const AssetLight wanted = light_asset(lights, 5, poses[1], objects[0].points);
    for (std::size_t p = 0; p < wanted.samples.size(); ++p)
      EXPECT_EQ(shadows.light_of(1)[p].channels, wanted.samples[p].channels);
  }
  EXPECT_EQ(ways.maps->work().passes, 0u);  // nothing is in the way, and static nodes have each other's shadow
}

TEST(VisibilityMaps, EnclosedReceiverGoesBlack) {
  const BothWays ways;
  const TriangleMesh shell = shapes::icosphere(2), ball = shapes::icosphere(2);
  const std::vector<ShadowObject> objects = {{&ball, ball.positions, 5, ball.normals}, {&shell, {}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 1}});
  SceneLights lights = lights_of(
      {ambient_light(), light_from_above(12), cone_from(40, 20, 70), light_from_above(0), lamp_at(40, 30, 20, 1)});
  lights.environment =
      hemisphere_light(3, Eigen::Vector3f(0.6f, 0.8f, 0), std::vector<float>{1, 2, 3}, std::vector<float>{0.5f, 0, 1});
  MovingShadows shadows = ways.by(tree, objects, true);
  const ScenePoses poses = {Placement{}, placed_at(1, 2, 3), placed_at(1, 2, 3, 8)};
  shadows.update(poses, lights);
  const double before = length_of(light_asset(lights, 5, poses[1], std::vector{Eigen::Vector3f{0, 0, 0}}).samples[0]);
  for (const LightCoefficients& light : shadows.light_of(1)) EXPECT_LT(length_of(light), 3e-6 * before);
}

/// A ball far away, as wide as three texels of the map: the mean of what it takes of a light of 12 degrees, at several
/// places, is its share of the light's solid angle.
TEST(VisibilityMaps, SmallOccluderFarAwayTakesItsShare) {
  BothWays ways;
  ways.settings.directions = 20000;
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {{0, 0, 0}}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  const SceneLights lights = lights_of({light_from_above(12)});
  MovingShadows shadows = ways.by(tree, objects, true);
  const auto whole = static_cast<double>(windowed_light(lights.specs[0], 5, LightWindow::none).channels[0][0]);
  const double half_angle = 0.6 * pi / 180, share = (1 - std::cos(half_angle)) / (1 - std::cos(12 * pi / 180));
  double mean = 0;
  constexpr int places = 16;
  for (int k = 0; k < places; ++k) {
    Eigen::Vector3d place(0.17 * std::sin(2.4 * k), 1, 0.17 * std::cos(2.4 * k) * k / places);
    place *= 1000 / place.norm();
    const Placement far_off = placed_at(place.x(), place.y(), place.z(), 1000 * std::sin(half_angle));
    shadows.update({Placement{}, placed_at(0, 0, 0, 1e-3), far_off}, lights);
    const double taken = 1 - static_cast<double>(shadows.light_of(1)[0].channels[0][0]) / whole;
    EXPECT_NEAR(taken, share, 0.65 * share);
    mean += taken / places;
  }
  EXPECT_NEAR(mean, share, 0.06 * share);
}

/// Occluders that a near plane would cut: a sheet of 1e-8 of the scene's size before the point, one that reaches from
/// there to behind it, and one that goes through the point itself.
TEST(VisibilityMaps, OccludersNextToThePointAreNotCut) {
  const BothWays ways;
  const TriangleMesh sheet = shapes::plane(1), ball = shapes::icosphere(2);
  const std::vector<ShadowObject> objects = {{&ball, {{0, 0, 0}}, 5, {}}, {&sheet, {}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 1}, {0, 0}});
  const Placement far_off = placed_at(0, -1000, 0);
  Placement upright = placed_at(0, 0, 0, 4);
  upright.rotation = Eigen::AngleAxisd(0.5 * pi, Eigen::Vector3d::UnitX()).toRotationMatrix();
  for (const LightSpec& light : {cone_from(30, 70, 12), light_from_above(60), ambient_light(), lamp_at(1, 8, 2, 2)}) {
    for (const double height : {1e-2, 1e-4, 2e-5})
      EXPECT_LT(
          ways.difference(tree, objects, {Placement{}, placed_at(0, 0, 0, 0.01), placed_at(0, height, 0, 4), far_off},
                          lights_of({light}), 0.15),
          0.01)
          << static_cast<int>(light.kind) << " " << height;
    Placement slanted = placed_at(0, 0.001, 0.001, 4);
    slanted.rotation = Eigen::AngleAxisd(0.9, Eigen::Vector3d::UnitX()).toRotationMatrix();
    EXPECT_LT(ways.difference(tree, objects, {Placement{}, placed_at(0, 0, 0, 0.01), slanted, far_off},
                              lights_of({light}), 0.15),
              0.02);
    // Seen edge on it covers nothing, and what touches the point does not darken it.
    const ScenePoses touching = {Placement{}, placed_at(0, 0, 0, 0.01), upright, far_off};
    for (const bool by_maps : {false, true}) {
      MovingShadows shadows = ways.by(tree, objects, by_maps);
      shadows.update(touching, lights_of({light}));
      const LightCoefficients open = light_asset(lights_of({light}), 5, touching[1], objects[0].points).samples[0];
      EXPECT_LT(largest_difference(shadows.light_of(1)[0], open), 0.02 * length_of(open)) << by_maps;
    }
  }
}

/// A lamp between the point and the occluder is not shadowed, one behind it is; in a scene 1e4 times as large, too.
TEST(VisibilityMaps, RaysEndAtBallsOfLight) {
  const BothWays ways;
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {{0, 0, 0}}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  for (const double size : {1.0, 1e4}) {
    const SceneLights lights = lights_of({lamp_at(0, 10 * size, 0, 2 * size)});
    const AssetLight open = light_asset(lights, 5, placed_at(0, 0, 0, 0.01 * size), objects[0].points);
    for (const double height : {5.0, 13.0}) {
      MovingShadows shadows = ways.by(tree, objects, true);
      shadows.update({Placement{}, placed_at(0, 0, 0, 0.01 * size), placed_at(0, height * size, 0, 2 * size)}, lights);
      if (height < 10)
        EXPECT_LT(length_of(shadows.light_of(1)[0]), 1e-5 * length_of(open.samples[0]));
      else
        EXPECT_EQ(shadows.light_of(1)[0].channels, open.samples[0].channels);
    }
    // Half of this one stands before the lamp's centre, half of it behind.
    EXPECT_LT(
        ways.difference(
            tree, objects,
            {Placement{}, placed_at(0, 0, 0, 0.01 * size), placed_at(0.5 * size, 8.2 * size, 0, 0.8 * size)}, lights),
        0.02);
  }
}

/// Many nodes, points and lights: no bit depends on how many maps are drawn at once, nor on what was kept; more texels
/// come nearer to rays, though a third of the sky is far below vertices' horizons, where few directions stand for all.
TEST(VisibilityMaps, NoBitDependsOnBatches) {
  const TriangleMesh ball = shapes::icosphere(1), wall = shapes::plane(3);
  const std::vector<ShadowObject> objects = {{&ball, ball.positions, 4, ball.normals}, {&wall, wall.positions, 3, {}}};
  const SceneTree tree = make_tree({{0, -1}, {1, 0}, {1, 0}, {0, 0}, {0, 1}});
  const ScenePoses poses = {Placement{},
                            Placement{},
                            placed_at(0, 1.2, 0, 0.5),
                            placed_at(1, 2, 0.3, 0.4),
                            placed_at(-1, 3, 0.5, 0.6),
                            placed_at(0, 0, 0, 6)};
  const SceneLights lights = lights_of({ambient_light(), cone_from(30, 60, 12), lamp_at(3, 6, 1, 1)});
  std::vector<std::vector<LightCoefficients>> found;
  std::vector<double> errors;
  const std::vector<VisibilityMapSettings> setups = {{32, 6 * 32 * 32 * 4}, {32}, {128}};
  for (const VisibilityMapSettings& setup : setups) {
    const BothWays ways(setup);
    MovingShadows shadows = ways.by(tree, objects, true), rays = ways.by(tree, objects, false);
    shadows.update(poses, lights);
    rays.update(poses, lights);
    if (setup.texels == 32) {
      auto& all = found.emplace_back();
      for (const int node : {2, 3, 4, 5})
        all.insert(all.end(), shadows.light_of(node).begin(), shadows.light_of(node).end());
      for (std::size_t k = 0; k < all.size(); ++k) EXPECT_EQ(all[k].channels, found[0][k].channels);
    }
    double error = 0;
    for (const int node : {2, 3, 4, 5})
      for (std::size_t p = 0; p < shadows.light_of(node).size(); ++p)
        error += std::pow(largest_difference(shadows.light_of(node)[p], rays.light_of(node)[p]), 2);
    errors.push_back(std::sqrt(error));
    const std::size_t passes = ways.maps->work().passes;
    EXPECT_GT(passes, setup.most_bytes < (1u << 20) ? 4u : 0u);
    shadows.update(poses, lights);
    EXPECT_EQ(ways.maps->work().passes, passes);
    EXPECT_EQ(shadows.statistics().computed, 0u);
  }
  EXPECT_LT(errors.back(), 0.6 * errors.front());
}

/// Where GL cannot draw in layers, the way is refused with what to do. In a process of its own, since Mesa reads the
/// variable once.
TEST(VisibilityMapsDeathTest, RefusesGlThatLacksLayers) {
  testing::GTEST_FLAG(death_test_style) = "threadsafe";
  const auto make = [] {
    setenv("MESA_EXTENSION_OVERRIDE", "-GL_ARB_shader_viewport_layer_array", 1);
    const EglContext context("software");
    try {
      const VisibilityMaps maps;
    } catch (const MachineLacks& lack) {
      std::fputs(lack.what(), stderr);
      std::_Exit(5);
    }
    std::_Exit(0);
  };
  EXPECT_EXIT(make(), testing::ExitedWithCode(5),
              "found no GL_ARB_shader_viewport_layer_array in .*--shadow-backend rays");
}

/// Drawing maps leaves the state of GL as it was.
TEST(VisibilityMaps, SetsTheStateBack) {
  const BothWays ways;
  glViewport(1, 2, 30, 40);
  glDepthFunc(GL_LEQUAL);
  glEnable(GL_BLEND);
  glEnable(GL_CULL_FACE);
  const TriangleMesh ball = shapes::icosphere(1);
  const std::vector<ShadowObject> objects = {{&ball, {{0, 0, 0}}, 5, {}}};
  ways.difference(make_tree({{0, 0}, {0, 0}}), objects, {Placement{}, placed_at(0, 0, 0), placed_at(0, 3, 0)},
                  lights_of({light_from_above(12)}));
  GLint viewport[4], number = 0;
  glGetIntegerv(GL_VIEWPORT, viewport);
  EXPECT_EQ((std::vector<GLint>(viewport, viewport + 4)), (std::vector<GLint>{1, 2, 30, 40}));
  glGetIntegerv(GL_DEPTH_FUNC, &number);
  EXPECT_EQ(number, GL_LEQUAL);
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &number);
  EXPECT_EQ(number, GL_NEGATIVE_ONE_TO_ONE);
  EXPECT_TRUE(glIsEnabled(GL_BLEND) && glIsEnabled(GL_CULL_FACE) && !glIsEnabled(GL_DEPTH_CLAMP));
  EXPECT_EQ(glGetError(), static_cast<GLenum>(GL_NO_ERROR));
  EXPECT_THROW(VisibilityMaps({4}), WrongUsage);
}

}  // namespace test_shadow_maps_gl
}  // namespace kiln
