// SPDX-License-Identifier: GPL-3.0-or-later
#include <gtest/gtest.h>
#include <numbers>

#include "sh/basis.h"
#include "shadow_scenes.h"

namespace kiln {
namespace test_moving_shadows {

constexpr double pi = std::numbers::pi;
const std::vector<ShadowMethod> all_methods = {
    ShadowMethod::none,           ShadowMethod::thesis, ShadowMethod::product,  ShadowMethod::subtraction,
    ShadowMethod::exponentiation, ShadowMethod::fields, ShadowMethod::combined,
};

ShadowSettings settings_of(ShadowMethod method, int directions = 1024) {
  ShadowSettings settings;
  settings.method = method;
  settings.directions = directions;
  return settings;
}

SceneLights lights_of(std::vector<LightSpec> specs, LightWindow window = LightWindow::hann) {
  return {std::move(specs), std::nullopt, window};
}

/// A ball of radius 1 with one sample point at its centre.
struct BallScene {
  TriangleMesh mesh = shapes::icosphere(3);
  ShadowObject object{&mesh, {Eigen::Vector3f::Zero()}, 5, {}};
};

TEST(MovingShadows, WithoutOccluderNothingChangesToTheBit) {
  const BallScene ball;
  const std::vector<ShadowObject> objects = {{&ball.mesh, ball.mesh.positions, 5, ball.mesh.normals}};
  const SceneTree tree = make_tree({{0, 0}});
  Placement pose = placed_at(1, 2, 3, 0.7);
  pose.rotation = Eigen::AngleAxisd(0.8, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  lamp.position = {4, 3, 2};
  const SceneLights lights = lights_of({ambient_light(), light_from_above(12), lamp, LightSpec{}});
  const AssetLight wanted = light_asset(lights, 5, pose, objects[0].points);
  for (const ShadowMethod method : all_methods) {
    MovingShadows shadows(tree, objects, settings_of(method, 256));
    shadows.update({Placement{}, pose}, lights);
    ASSERT_EQ(shadows.light_of(1).size(), wanted.samples.size());
    for (std::size_t p = 0; p < wanted.samples.size(); ++p)
      EXPECT_EQ(shadows.light_of(1)[p].channels, wanted.samples[p].channels);
  }
}

TEST(MovingShadows, OccludersBesideTheLightChangeNothingToTheBit) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}, {0, 0}});
  const ScenePoses poses = {Placement{}, placed_at(0, 0, 0), placed_at(6, 1, 0), placed_at(0, -4, 0)};
  const SceneLights lights = lights_of({light_from_above(0), light_from_above(20)});
  MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
  shadows.update(poses, lights);
  EXPECT_EQ(shadows.light_of(1)[0].channels, light_asset(lights, 5, poses[1], ball.object.points).samples[0].channels);
}

/// A ball on the axis of a cone of light covers a cap of it, whose coefficients are those of a thinner cone of the same
/// radiance: the light's less the cap's is left, each band times its window.
TEST(MovingShadows, BallBeforeAConeOfLightAgreesWithClosedForm) {
  const TriangleMesh fine = shapes::icosphere(5);
  const std::vector<ShadowObject> objects = {{&fine, {Eigen::Vector3f::Zero()}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  for (const LightWindow window : {LightWindow::none, LightWindow::hann})
    for (const double light_degrees : {6.0, 12.0, 30.0, 80.0})
      for (const double ball_degrees : {3.0, 5.0, 10.0, 25.0, 40.0}) {
        const double light = light_degrees * pi / 180, cap = ball_degrees * pi / 180;
        const ScenePoses poses = {Placement{}, placed_at(0, 0, 0, 0.01), placed_at(0, 1 / std::sin(cap), 0)};
        const LightSpec spec = light_from_above(light_degrees);
        MovingShadows shadows(tree, objects, settings_of(ShadowMethod::combined, 4096));
        shadows.update(poses, lights_of({spec}, window));
        const LightCoefficients whole = windowed_light(spec, 5, window);
        const std::vector<double> of_light = cone_bands(5, light), of_cap = cone_bands(5, cap);
        const double ratio = std::pow(std::sin(cap) / std::sin(light), 2);  // cone_bands divides by these
        LightCoefficients wanted = whole;
        for (std::size_t i = 0; i < 25; ++i) {
          const auto l = static_cast<std::size_t>(band_of(static_cast<int>(i)));
          const double left = cap < light ? 1 - of_cap[l] * ratio / of_light[l] : 0;
          for (std::vector<float>& channel : wanted.channels)
            channel[i] = static_cast<float>(left * static_cast<double>(channel[i]));
        }
        // 4,096 directions, and a mesh whose silhouette is 0.1 % too small.
        EXPECT_LT(largest_difference(shadows.light_of(1)[0], wanted), cap < light ? 0.012 * length_of(whole) : 2e-6)
            << light_degrees << " " << ball_degrees;
      }
}

TEST(MovingShadows, EnclosedReceiverGoesBlack) {
  const TriangleMesh shell = shapes::icosphere(2);
  const BallScene ball;
  const std::vector<ShadowObject> objects = {{&ball.mesh, ball.mesh.positions, 5, ball.mesh.normals},
                                             {&shell, {}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 1}});
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  lamp.position = {40, 30, 20};
  LightSpec half;
  half.kind = LightSpec::Kind::hemisphere;
  half.ground = {0.1f, 0.2f, 0.3f};
  SceneLights lights = lights_of({ambient_light(), light_from_above(12), light_from_above(0), lamp, half});
  lights.environment =
      hemisphere_light(3, Eigen::Vector3f(0.6f, 0.8f, 0), std::vector<float>{1, 2, 3}, std::vector<float>{0.5f, 0, 1});
  MovingShadows shadows(tree, objects, settings_of(ShadowMethod::combined));
  const ScenePoses poses = {Placement{}, placed_at(1, 2, 3), placed_at(1, 2, 3, 8)};
  shadows.update(poses, lights);
  const double before = length_of(light_asset(lights, 5, poses[1], std::vector{Eigen::Vector3f{0, 0, 0}}).samples[0]);
  for (const LightCoefficients& light : shadows.light_of(1)) EXPECT_LT(length_of(light), 3e-6 * before);
}

/// Half the sphere around a point is a wall: of light from everywhere, half is left, and the facing hemisphere's
/// radiance is that of the unshadowed.
TEST(MovingShadows, WallTakesHalfOfTheSky) {
  const TriangleMesh wall = shapes::plane(1, 2000);
  const BallScene ball;
  const std::vector<ShadowObject> objects = {ball.object, {&wall, {}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 1}});
  MovingShadows shadows(tree, objects, settings_of(ShadowMethod::combined, 4096));
  shadows.update({Placement{}, placed_at(0, 1, 0), placed_at(0, 0, 0)}, lights_of({ambient_light()}));
  const std::vector<float>& left = shadows.light_of(1)[0].channels[0];
  EXPECT_NEAR(left[0], 0.5 * std::sqrt(4 * pi), 0.004);
  EXPECT_NEAR(left[1], std::sqrt(3 / (4 * pi)) * pi, 0.004);  // of y over the upper half
  EXPECT_NEAR(left[2], 0, 0.004);
  EXPECT_NEAR(left[3], 0, 0.004);
}

TEST(MovingShadows, EqualOccludersOnBothSidesGiveMirroredLight) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}, {0, 0}});
  for (const ShadowMethod method :
       {ShadowMethod::thesis, ShadowMethod::exponentiation, ShadowMethod::fields, ShadowMethod::combined}) {
    MovingShadows shadows(tree, {ball.object}, settings_of(method, 4096));
    shadows.update({Placement{}, placed_at(0, 0, 0), placed_at(3, 0, 0), placed_at(-3, 0, 0)},
                   lights_of({ambient_light()}));
    const std::vector<float>& light = shadows.light_of(1)[0].channels[0];
    EXPECT_LT(light[0], 0.97 * std::sqrt(4 * pi));
    EXPECT_NEAR(light[3], 0, 0.02) << shadow_method_names[static_cast<std::size_t>(method)];  // x
    EXPECT_NEAR(light[1], 0, 0.01);
    EXPECT_LT(light[8], -0.01);  // x^2 - y^2... less light along x
  }
}

TEST(MovingShadows, LampsAreShadowedOnlyByWhatStandsBeforeThem) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  for (const double radius : {1e-4, 0.3}) {
    lamp.position = {0, 5, 0};
    lamp.radius = radius;
    const SceneLights lights = lights_of({lamp});
    const auto light_with = [&](double height) {
      MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
      shadows.update({Placement{}, placed_at(0, 0.5, 0, 0.1), placed_at(0.01, height, 0)}, lights);
      return shadows.light_of(1)[0];
    };
    const LightCoefficients whole = light_asset(lights, 5, placed_at(0, 0.5, 0, 0.1), ball.object.points).samples[0];
    EXPECT_EQ(light_with(6.5).channels, whole.channels);
    EXPECT_EQ(light_with(-3).channels, whole.channels);
    EXPECT_LT(length_of(light_with(2.5)), 1e-5 * length_of(whole));
  }
}

/// Compares the share of a ball's light that is left with that of rays at perfect spheres, for occluders all around the
/// way to the light: none that matters is overlooked.
TEST(MovingShadows, LampsLoseTheShareThatIsHidden) {
  const TriangleMesh fine = shapes::icosphere(4);
  const std::vector<ShadowObject> objects = {{&fine, {Eigen::Vector3f::Zero()}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  lamp.position = {1, 6, 2};
  lamp.radius = 2;
  const Eigen::Vector3d centre(lamp.position.data());
  const SceneLights lights{{lamp}, std::nullopt, LightWindow::none};
  const double sine = lamp.radius / centre.norm(), depth = 1 - std::sqrt(1 - sine * sine);
  const Eigen::Vector3d axis = centre.normalized(), side = axis.unitOrthogonal(), up = axis.cross(side);
  MovingShadows shadows(tree, objects, settings_of(ShadowMethod::combined, 4096));
  int partly = 0;
  for (int k = 0; k < 200; ++k) {
    // Places in a box around the way, by the additive recurrence of the plastic number.
    const auto part = [&](double step) { return std::fmod(step * (k + 1), 1.0) - 0.5; };
    const Eigen::Vector3d place =
        0.5 * centre + Eigen::Vector3d(8 * part(0.8191725), 8 * part(0.6710436), 8 * part(0.5497005));
    const double radius = 0.5;
    if (place.norm() < 1.1 * radius) continue;
    int hidden = 0;
    constexpr int rays = 4000;
    for (int r = 0; r < rays; ++r) {
      const double z = 1 - depth * (r + 0.5) / rays, around = 2.399963229728653 * r, out = std::sqrt(1 - z * z);
      const Eigen::Vector3d ray = z * axis + out * (std::cos(around) * side + std::sin(around) * up);
      const auto distance_to = [&](const Eigen::Vector3d& middle, double of_radius) {
        const double along = ray.dot(middle), inside = of_radius * of_radius - middle.squaredNorm() + along * along;
        return inside < 0 || along < 0 ? 1e9 : along - std::sqrt(inside);
      };
      hidden += distance_to(place, radius) < distance_to(centre, lamp.radius) ? 1 : 0;
    }
    partly += hidden > 0 && hidden < rays ? 1 : 0;
    shadows.update({Placement{}, placed_at(0, 0, 0, 0.01), placed_at(place.x(), place.y(), place.z(), radius)}, lights);
    const double whole = static_cast<double>(windowed_light(lamp, 5, LightWindow::none).channels[0][0]);
    EXPECT_NEAR(static_cast<double>(shadows.light_of(1)[0].channels[0][0]) / whole, 1 - hidden / double{rays}, 0.01)
        << place.transpose();
  }
  EXPECT_GT(partly, 5);
}

TEST(MovingShadows, StaticNodesLeaveEachOtherAlone) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0, true}, {0, 0, true}, {0, 0, false}});
  const SceneLights lights = lights_of({ambient_light(), light_from_above(12)});
  const Placement far_away = placed_at(1000, 0, 0), below = placed_at(0, 0, 0), above = placed_at(0, 3, 0);
  for (const ShadowMethod method : all_methods) {
    if (method == ShadowMethod::none) continue;
    MovingShadows shadows(tree, {ball.object}, settings_of(method));
    const LightCoefficients whole = light_asset(lights, 5, below, ball.object.points).samples[0];
    shadows.update({Placement{}, below, above, far_away}, lights);
    EXPECT_LT(largest_difference(shadows.light_of(1)[0], whole), 1e-4);  // the far one covers a millionth of the sky
    shadows.update({Placement{}, below, far_away, above}, lights);
    EXPECT_GT(largest_difference(shadows.light_of(1)[0], whole), 0.1);
    EXPECT_GT(largest_difference(shadows.light_of(3)[0], whole), 1e-3);  // the static one below takes sky
  }
}

TEST(MovingShadows, AnyNumberOfThreadsGivesTheSameBits) {
  const TriangleMesh mesh = shapes::icosphere(2);
  const std::vector<ShadowObject> objects = {{&mesh, mesh.positions, 4, mesh.normals}};
  const SceneTree tree = make_tree({{0, 0}, {0, -1}, {2, 0}, {2, 0}, {0, 0}});
  const ScenePoses poses = {Placement{},          placed_at(0, 0, 0),     Placement{},
                            placed_at(0, 2.5, 0), placed_at(2.2, 2, 0.5), placed_at(-2.1, 1, 0.3, 0.6)};
  LightSpec lamp;
  lamp.kind = LightSpec::Kind::sphere;
  lamp.position = {3, 6, 1};
  const SceneLights lights = lights_of({ambient_light(), light_from_above(12), lamp});
  for (const ShadowMethod method : all_methods) {
    std::vector<std::vector<LightCoefficients>> first;
    for (const int threads : {1, 2, 3}) {
      ShadowSettings settings = settings_of(method, 200);
      settings.threads = threads;
      MovingShadows shadows(tree, objects, settings);
      shadows.update(poses, lights);
      for (const int node : {1, 3, 4, 5}) {
        const std::span<const LightCoefficients> light = shadows.light_of(node);
        if (threads == 1) first.emplace_back(light.begin(), light.end());
        const std::vector<LightCoefficients>& wanted = first[node == 1 ? 0 : static_cast<std::size_t>(node - 2)];
        for (std::size_t p = 0; p < light.size(); ++p) EXPECT_EQ(light[p].channels, wanted[p].channels);
      }
    }
  }
}

/// Light from above; a ball over a ball, and one beside them.
TEST(MovingShadows, MovingANodeRecomputesOnlyWhatCanSeeIt) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}, {0, 0}});
  ScenePoses poses = {Placement{}, placed_at(0, 0, 0), placed_at(0, 3, 0), placed_at(9, 0, 0)};
  SceneLights lights = lights_of({light_from_above(12)});
  MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
  const auto computed_after = [&] {
    shadows.update(poses, lights);
    const ShadowStatistics& statistics = shadows.statistics();
    EXPECT_EQ(statistics.computed + statistics.kept, 3u);
    return statistics.computed;
  };
  EXPECT_EQ(computed_after(), 3u);
  EXPECT_EQ(computed_after(), 0u);
  poses[3].translation.x() = 8;  // sees no other, and is seen by none; light from afar is the same there
  EXPECT_EQ(computed_after(), 0u);
  poses[2].translation.y() = 2.5;  // shadows the lowest
  EXPECT_EQ(computed_after(), 1u);
  poses[3].rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d::UnitX()).toRotationMatrix();
  EXPECT_EQ(computed_after(), 1u);
  for (Placement& pose : poses) pose.translation += Eigen::Vector3d(0.3, 0.1, 0.7);  // all together
  EXPECT_EQ(computed_after(), 0u);
  poses[2].translation.x() = -9;  // leaves the light of the lowest
  EXPECT_EQ(computed_after(), 1u);
  lights.specs[0].elevation_degrees = 80;
  EXPECT_EQ(computed_after(), 3u);
  lights.specs.push_back(ambient_light());  // now all see all
  EXPECT_EQ(computed_after(), 3u);
  poses[3].translation.x() += 1;
  EXPECT_EQ(computed_after(), 3u);
}

/// What is kept is what would be computed: many small steps, each below any threshold, do not add up unseen.
TEST(MovingShadows, KeptLightIsThatOfANewComputation) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  const SceneLights lights = lights_of({light_from_above(30)});
  MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
  ScenePoses poses = {Placement{}, placed_at(0, 0, 0), placed_at(-1.6, 3, 0)};
  for (int step = 0; step < 40; ++step) {
    poses[2].translation.x() += 0.04;
    shadows.update(poses, lights);
    MovingShadows fresh(tree, {ball.object}, settings_of(ShadowMethod::combined));
    fresh.update(poses, lights);
    ASSERT_EQ(shadows.light_of(1)[0].channels, fresh.light_of(1)[0].channels) << step;
  }
}

/// A ball passes a light in small steps: light falls to its least and rises again, and never goes back on its way by
/// more than two directions' worth.
TEST(MovingShadows, NothingFlickersAsABallPasses) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  const SceneLights lights = lights_of({light_from_above(12)});
  MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
  std::vector<double> means;
  constexpr int steps = 200;
  for (int step = 0; step <= steps; ++step) {
    shadows.update({Placement{}, placed_at(0, 0, 0, 0.2), placed_at(-4 + 8.0 * step / steps, 8, 0)}, lights);
    means.push_back(static_cast<double>(shadows.light_of(1)[0].channels[0][0]));
  }
  const auto least = std::min_element(means.begin(), means.end());
  EXPECT_EQ(means.front(), means.back());
  // A ball of 7.2 degrees takes from a light of 12 the share of their squared sines.
  EXPECT_NEAR(*least / means.front(), 1 - std::pow(std::sin(std::asin(1.0 / 8)) / std::sin(12 * pi / 180), 2), 0.01);
  const double direction = means.front() / 1024;
  for (auto value = means.begin() + 1; value != means.end(); ++value) {
    const double change = value <= least ? *(value - 1) - *value : *value - *(value - 1);
    EXPECT_GT(change, -6.01 * direction);
    EXPECT_LT(change, 0.04 * means.front());  // of the steepest: 0.04 of a path, half of it in light
  }
}

/// Compares caps with many rays; of two caps one behind the other only one counts.
TEST(MovingShadows, SmallNodesAreCapsOfTheirSilhouette) {
  const BallScene ball;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}, {0, 0}});
  const SceneLights lights = lights_of({ambient_light()});
  const auto taken = [&](const Placement& one, const Placement& other, double cap_degrees, int directions) {
    ShadowSettings settings = settings_of(ShadowMethod::combined, directions);
    settings.cap_degrees = cap_degrees;
    MovingShadows shadows(tree, {ball.object}, settings);
    shadows.update({Placement{}, placed_at(0, 0, 0, 1e-3), one, other}, lights);
    const LightCoefficients whole = constant_light(5, std::vector<float>{1, 1, 1});
    return add_lights(whole, scale_light(shadows.light_of(1)[0], -1));
  };
  const Placement near = placed_at(20, 3, 4), behind = placed_at(40, 6, 8), away = placed_at(-20, 9, 0),
                  far_off = placed_at(1e9, 0, 0);
  const LightCoefficients one = taken(near, far_off, 4, 256);
  EXPECT_LT(largest_difference(one, taken(near, far_off, 0, 100000)), 0.03 * length_of(one));
  EXPECT_LT(largest_difference(one, taken(near, behind, 4, 256)), 1e-6);
  const LightCoefficients both = taken(near, away, 4, 256), other = taken(away, far_off, 4, 256);
  EXPECT_LT(largest_difference(both, add_lights(one, other)), 1e-6);
}

/// A probe set that passes all light on as it is changes no more than rounding and the light's own harmonics do.
TEST(MovingShadows, ProbesThatPassAllLightChangeNothing) {
  const BallScene ball;
  ProbeSet probes;
  probes.bands = 5;
  probes.positions = {Eigen::Vector3f::Zero()};
  probes.valid = {1};
  probes.matrices.resize(25 * 25);
  for (std::size_t i = 0; i < 25; ++i) probes.matrices[26 * i] = 1;
  const SceneTree tree = make_tree({{0, 0}, {0, 0}});
  const ScenePoses poses = {Placement{}, placed_at(0, 0, 0), placed_at(0.5, 2.5, 0)};
  SceneLights lights = lights_of({ambient_light()});
  MovingShadows shadows(tree, {ball.object}, settings_of(ShadowMethod::combined));
  shadows.update(poses, lights);
  const LightCoefficients without = shadows.light_of(1)[0];
  lights.probes = &probes;
  shadows.update(poses, lights);
  EXPECT_LT(largest_difference(without, shadows.light_of(1)[0]), 1e-5);
  EXPECT_LT(without.channels[0][0], 0.97 * std::sqrt(4 * pi));
}

}  // namespace test_moving_shadows
}  // namespace kiln
