// SPDX-License-Identifier: GPL-3.0-or-later
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

#include "runtime/shadow/shadow_field.h"
#include "runtime/shadow/silhouette.h"
#include "runtime/shadow/sphere_set.h"
#include "runtime/shadow/tree_filters.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/exponential.h"
#include "sh/product.h"
#include "sh/quadrature.h"
#include "sh/windows.h"
#include "shadow_scenes.h"

namespace kiln {
namespace test_shadow_filters {

constexpr double pi = std::numbers::pi;

/// Projects a function of direction by dense sums.
template <class Function>
std::vector<float> projected(int bands, Function function, int count = 40000) {
  const ShBasis basis(bands);
  std::vector<double> sum(static_cast<std::size_t>(basis.size())), values(sum.size());
  for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, count, 7)) {
    const double there = function(direction.cast<double>().eval());
    if (there == 0) continue;
    basis.evaluate<double>(direction.cast<double>(), values);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += 4 * pi / count * there * values[i];
  }
  return {sum.begin(), sum.end()};
}

double difference(std::span<const float> a, std::span<const float> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += std::pow(static_cast<double>(a[i]) - static_cast<double>(b[i]), 2);
  return std::sqrt(sum);
}

TEST(ShExponential, AgreesWithQuadrature) {
  std::mt19937 generator(5);
  std::normal_distribution<float> normal;
  for (int bands = 1; bands <= 6; ++bands)
    for (const float size : {0.1f, 0.5f, 1.5f}) {
      std::vector<float> f(static_cast<std::size_t>(coefficient_count(bands)));
      for (float& value : f) value = size * normal(generator) / std::sqrt(static_cast<float>(f.size()));
      const std::vector<float> wanted = projected(
          bands, [&](const Eigen::Vector3d& s) { return std::exp(evaluate_at(f, s.cast<float>())); }, 4000);
      const double length = difference(wanted, std::vector<float>(f.size(), 0.f));
      EXPECT_LT(difference(ShExponential::of_bands(bands)(f), wanted), (size < 1 ? 0.03 : 0.08) * length)
          << bands << " bands, " << size;
    }
}

/// The exponential of a ball's logarithm is its visibility, and that of a sum the visibility past both.
TEST(ShExponential, LogarithmsOfBallsAddUp) {
  constexpr int bands = 5;
  const Eigen::Vector3d one = Eigen::Vector3d(1, 2, 2) / 3, other = Eigen::Vector3d(2, -1, 2).normalized();
  for (const double degrees : {5.0, 15.0, 25.0}) {
    const double angle = degrees * pi / 180, distance = 1 / std::sin(angle);
    const auto hidden = [&](const Eigen::Vector3d& s, const Eigen::Vector3d& axis) {
      return s.dot(axis) > std::cos(angle);
    };
    const std::vector<BoundingBall> balls = {{distance * one, 1}, {distance * other, 1}};
    const ShExponential& exponential = ShExponential::of_bands(bands);
    const std::vector<float> single = exponential(log_visibility(std::span(balls).first(1), {0, 0, 0}, bands)),
                             both = exponential(log_visibility(balls, {0, 0, 0}, bands));
    const std::vector<float> wanted_single =
        projected(bands, [&](const Eigen::Vector3d& s) { return hidden(s, one) ? 0. : 1.; });
    const std::vector<float> wanted_both =
        projected(bands, [&](const Eigen::Vector3d& s) { return hidden(s, one) || hidden(s, other) ? 0. : 1.; });
    std::vector<float> open(25, 0.f);
    open[0] = static_cast<float>(std::sqrt(4 * pi));
    EXPECT_LT(difference(single, wanted_single), 0.2 * difference(open, wanted_single)) << degrees;
    EXPECT_LT(difference(both, wanted_both), 0.25 * difference(open, wanted_both)) << degrees;
  }
}

TEST(SphereSet, StandsForMeshes) {
  const TriangleMesh ball = shapes::icosphere(3);
  TriangleMesh dumbbell = shapes::icosphere(2, 0.5f);
  TriangleMesh right = dumbbell;
  for (Eigen::Vector3f& position : right.positions) position.x() += 1.5f;
  dumbbell.normals.clear();
  dumbbell.uvs.clear();
  right.normals.clear();
  append(dumbbell, right);
  for (const TriangleMesh* mesh : {&ball, static_cast<const TriangleMesh*>(&dumbbell)}) {
    const BoundingBall bound = bounding_ball(*mesh);
    const SilhouetteRays rays = cast_silhouettes(RayOccluder(*mesh), bound);
    const double few = fit_spheres(*mesh, rays, 2).mismatch, many = fit_spheres(*mesh, rays, 48).mismatch;
    EXPECT_LT(many, 0.12);
    EXPECT_LT(many, few + 0.05);
  }
  // Two balls are two balls.
  const SphereSet two = fit_spheres(dumbbell, cast_silhouettes(RayOccluder(dumbbell), bounding_ball(dumbbell)), 2);
  ASSERT_EQ(two.balls.size(), 2u);
  EXPECT_LT(two.mismatch, 0.05);
  EXPECT_NEAR(std::abs(two.balls[0].centre.x() - two.balls[1].centre.x()), 1.5, 0.05);
}

TEST(Silhouette, OfABallIsItsDisc) {
  const TriangleMesh ball = shapes::icosphere(4);
  const BoundingBall bound = bounding_ball(ball);
  EXPECT_NEAR(bound.radius, 1, 1e-3);
  EXPECT_NEAR(silhouette_radius(cast_silhouettes(RayOccluder(ball), bound), bound), 1, 0.01);
}

TEST(ShadowField, AgreesWithRays) {
  TriangleMesh mesh = shapes::icosphere(2, 0.5f);
  for (Eigen::Vector3f& position : mesh.positions) position = position.cwiseProduct(Eigen::Vector3f(2, 0.6f, 1));
  const RayOccluder rays(mesh);
  const BoundingBall ball = bounding_ball(mesh);
  const double silhouette = silhouette_radius(cast_silhouettes(rays, ball), ball);
  const ShadowField field(rays, ball, silhouette, 5);
  const DirectionSet set = sphere_directions(20000, 5);
  for (const Eigen::Vector3d& point :
       {Eigen::Vector3d(0.3, 1.4, 0.2), Eigen::Vector3d(-2, 0.4, 1), Eigen::Vector3d(0.1, -3, 2.2),
        Eigen::Vector3d(1.2, 0, 0), Eigen::Vector3d(3, 12, 1)}) {
    std::vector<std::uint8_t> blocked(set.count(), 0);
    std::vector<std::uint32_t> all(set.count());
    for (std::uint32_t d = 0; d < set.count(); ++d) all[d] = d;
    rays.block({}, point, set, all, {}, blocked);
    std::vector<float> wanted(25, 0.f), open(25, 0.f);
    open[0] = wanted[0] = static_cast<float>(std::sqrt(4 * pi));
    for (std::uint32_t d = 0; d < set.count(); ++d)
      if (blocked[d] != 0)
        for (std::size_t i = 0; i < 25; ++i) wanted[i] -= static_cast<float>(4 * pi / set.count()) * set.row(d)[i];
    // Beyond the shells a cap of the mean silhouette stands for the flat mesh, seen from its broad side here; next to
    // its tip points are too far apart for what they see.
    const double tolerance = point.norm() > 8 * ball.radius ? 0.6 : point.norm() < 1.3 * ball.radius ? 0.3 : 0.08;
    EXPECT_LT(difference(field.visibility(point), wanted), tolerance * difference(open, wanted)) << point.transpose();
  }
}

ShadowSettings settings_of(ShadowMethod method) {
  ShadowSettings settings;
  settings.method = method;
  return settings;
}

/// What shadows a composite node shadows what is in it: one ball in a composite node beside another ball has the filter
/// of two balls in one node, as its point is the composite node's.
TEST(TreeFilters, PassDownTheTree) {
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {Eigen::Vector3f::Zero()}, 5, {}}};
  LightSpec ambient = ambient_light();
  const SceneLights lights{{ambient, light_from_above(20)}, std::nullopt, LightWindow::hann};
  for (const ShadowMethod method : {ShadowMethod::thesis, ShadowMethod::product, ShadowMethod::subtraction}) {
    MovingShadows flat(make_tree({{0, 0}, {0, 0}}), objects, settings_of(method));
    flat.update({Placement{}, placed_at(0, 0, 0), placed_at(0.5, 3, 0)}, lights);
    MovingShadows nested(make_tree({{0, -1}, {1, -1}, {2, 0}, {0, 0}}), objects, settings_of(method));
    nested.update({Placement{}, Placement{}, Placement{}, placed_at(0, 0, 0), placed_at(0.5, 3, 0)}, lights);
    const LightCoefficients whole = light_asset(lights, 5, {}, objects[0].points).samples[0];
    EXPECT_GT(largest_difference(flat.light_of(1)[0], whole), 0.1);
    EXPECT_LT(largest_difference(flat.light_of(1)[0], nested.light_of(3)[0]), 1e-4);
  }
}

/// A composite node's shadow is that of its meshes, or of the ball around them.
TEST(TreeFilters, SeeCompositeNodesAsMeshesOrAsBalls) {
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {Eigen::Vector3f::Zero()}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, -1}, {2, 0}, {2, 0}});
  const ScenePoses poses = {Placement{}, placed_at(0, 0, 0), Placement{}, placed_at(-2, 5, 0), placed_at(2, 5, 0)};
  const SceneLights lights{{ambient_light()}, std::nullopt, LightWindow::hann};
  ShadowSettings settings = settings_of(ShadowMethod::product);
  const auto taken = [&] {
    MovingShadows shadows(tree, objects, settings);
    shadows.update(poses, lights);
    return 1 - static_cast<double>(shadows.light_of(1)[0].channels[0][0]) / std::sqrt(4 * pi);
  };
  const auto share = [](double sine) { return 0.5 * (1 - std::sqrt(1 - sine * sine)); };
  EXPECT_NEAR(taken(), 2 * share(1 / std::hypot(2, 5)), 0.003);
  settings.composite_balls = true;
  EXPECT_NEAR(taken(), share(3 / 5.0), 0.003);
}

/// A ball moves inside the ball around its composite node ([Chapter 2010], 5.3): with balls, only the filters of its
/// own level are computed anew; with meshes, that of the node beside the composite one, too.
TEST(TreeFilters, MotionWithinABallStaysWithinIt) {
  const TriangleMesh ball = shapes::icosphere(3);
  const std::vector<ShadowObject> objects = {{&ball, {Eigen::Vector3f::Zero()}, 5, {}}};
  const SceneTree tree = make_tree({{0, 0}, {0, -1}, {2, 0}, {2, 0}});
  const SceneLights lights{{ambient_light()}, std::nullopt, LightWindow::hann};
  for (const bool balls : {false, true}) {
    ShadowSettings settings = settings_of(ShadowMethod::thesis);
    settings.composite_balls = balls;
    MovingShadows shadows(tree, objects, settings);
    ScenePoses poses = {Placement{}, placed_at(-8, 0, 0), Placement{}, placed_at(0, 0, 0, 2), placed_at(1, 0, 0, 0.3)};
    shadows.update(poses, lights);
    EXPECT_EQ(shadows.statistics().computed, 4u);
    shadows.update(poses, lights);
    EXPECT_EQ(shadows.statistics().computed, 0u);
    poses[4].translation.y() = 0.5;
    shadows.update(poses, lights);
    EXPECT_EQ(shadows.statistics().computed, balls ? 2u : 3u);  // both in the composite node, and the one beside it
    poses[4].translation.y() = 4;  // leaves the ball: the composite node's own filter has another place
    shadows.update(poses, lights);
    EXPECT_EQ(shadows.statistics().computed, 4u);
  }
}

/// The study that the methods were chosen by: discs of light and of occluders, exit radiance of all normals, against
/// the product that is cut last. Prints, in % of the unshadowed: thesis, product, product of nine bands.
TEST(TreeFilters, WindowsAndEarlyCutsCostAccuracy) {
  struct Case {
    double light, occluder;
    int occluders;
  };
  constexpr int bands = 5, many = 9, trials = 12;
  std::mt19937 generator(3);
  std::uniform_real_distribution<double> uniform;
  const std::vector<Eigen::Vector3f> normals = sample_directions(Sampling::fibonacci, 256, 1);
  const ShBasis basis(bands);
  for (const auto& [light_degrees, occluder_degrees, occluders] : {Case{12, 20, 1}, Case{12, 10, 6}, Case{30, 20, 4}}) {
    const double light = light_degrees * pi / 180, cap = occluder_degrees * pi / 180;
    double errors[3] = {0, 0, 0}, whole = 0;
    for (int trial = 0; trial < trials; ++trial) {
      // Occluders lie over the light or touch it.
      std::vector<Eigen::Vector3d> axes;
      for (int k = 0; k < occluders; ++k) {
        const double reach = light + cap, z = std::cos(reach * uniform(generator)), phi = 2 * pi * uniform(generator);
        axes.emplace_back(std::sqrt(1 - z * z) * std::cos(phi), std::sqrt(1 - z * z) * std::sin(phi), z);
      }
      const auto shines = [&](const Eigen::Vector3d& s) {
        return s.z() > std::cos(light) ? 1 / std::pow(std::sin(light), 2) : 0;
      };
      const auto visible = [&](const Eigen::Vector3d& s) {
        return std::none_of(axes.begin(), axes.end(), [&](const auto& axis) { return axis.dot(s) > std::cos(cap); })
                   ? 1.
                   : 0.;
      };
      const std::vector<float> f = projected(many, shines), g = projected(many, visible);
      const std::vector<float> exact =
          projected(bands, [&](const Eigen::Vector3d& s) { return shines(s) * visible(s); });
      std::vector<float> f_few(f.begin(), f.begin() + 25), g_few(g.begin(), g.begin() + 25), f_window = f_few;
      const std::vector<double> window = hann_window(bands);
      for (std::size_t i = 0; i < 25; ++i)
        f_window[i] *= static_cast<float>(window[static_cast<std::size_t>(band_of(static_cast<int>(i)))]);
      const LightCoefficients few{bands, {f_few}}, windowed{bands, {f_window}};
      const std::vector<float> results[3] = {filtered_light(ShadowMethod::thesis, windowed, g_few).channels[0],
                                             filtered_light(ShadowMethod::product, few, g_few).channels[0],
                                             ShProduct::of_bands(many, bands)(f, g)};
      for (const Eigen::Vector3f& normal : normals) {
        const std::vector<float> transfer = unoccluded_transfer(basis, normal);
        const double wanted = dot_product(exact, transfer);
        whole += std::pow(dot_product(f_few, transfer), 2);
        for (int k = 0; k < 3; ++k) errors[k] += std::pow(dot_product(results[k], transfer) - wanted, 2);
      }
    }
    for (double& error : errors) error = 100 * std::sqrt(error / whole);
    std::printf("light %g, %d of %g degrees: %.1f %.1f %.1f %%\n", light_degrees, occluders, occluder_degrees,
                errors[0], errors[1], errors[2]);
    EXPECT_GT(errors[0], errors[1]);
    EXPECT_GT(errors[1], 1.5 * errors[2]);
  }
}

}  // namespace test_shadow_filters
}  // namespace kiln
