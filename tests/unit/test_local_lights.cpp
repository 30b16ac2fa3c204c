// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <vector>

#include "base/errors.h"
#include "prt_folders.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"
#include "scratch.h"
#include "sh/light_spec.h"
#include "sh/rotation.h"
#include "sh/transfer.h"
#include "shapes.h"

namespace kiln {
namespace test_local_lights {

using namespace test;

SceneLights one_light(const std::string& text, LightWindow window = LightWindow::none) {
  return {{parse_light_spec(text)}, std::nullopt, window};
}

TEST(LocalLight, BallFallsWithTheSquareOfTheDistance) {
  // A white surface that faces the ball has the radiance 1 at the origin; halfway to the ball, 4 times that.
  const LightSpec ball = parse_light_spec("sphere:0,0,2,0.05");
  const auto radiance_at = [&](double z) {
    const LightCoefficients light = irradiance(light_coefficients(ball, 24, {0, 0, z}));
    return evaluate_at(light.channels[0], {0, 0, 1}) / std::numbers::pi;
  };
  // The truncated series of the clamped cosine is a little off at its peak, by the same factor everywhere.
  EXPECT_NEAR(radiance_at(0), 1, 0.005);
  for (const double z : {1.0, -2.0, -6.0}) {
    const double expected = 4 / ((2 - z) * (2 - z));
    EXPECT_NEAR(radiance_at(z) / radiance_at(0), expected, 2e-3 * expected) << z;
  }
  // Inside, the ball's own radiance comes from everywhere.
  const double sine = 0.05 / 2;
  const LightCoefficients inside = light_coefficients(ball, 3, {0.01, 0, 2});
  EXPECT_NEAR(evaluate_at(inside.channels[0], {1, 0, 0}), 1 / (sine * sine), 1e-3 / (sine * sine));
}

TEST(LocalLight, ContributionsReproduceLinearLight) {
  for (const int count : {1, 2, 6, 8}) {
    const TriangleMesh mesh = shapes::icosphere(3, 2.5f);
    const IncidentSamples samples = place_incident_samples(mesh, count);
    ASSERT_EQ(samples.count(), count);
    for (const Eigen::Vector3f& point : samples.points)
      EXPECT_NEAR(point.norm(), count > 1 ? 2.5 / std::sqrt(2.0) : 0, 1e-3);
    double error = 0;
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      double sum = 0;
      Eigen::Vector3d place = Eigen::Vector3d::Zero();
      for (int k = 0; k < count; ++k) {
        const double contribution = samples.contributions[v * static_cast<std::size_t>(count) + k];
        sum += contribution;
        place += contribution * samples.points[static_cast<std::size_t>(k)].cast<double>();
      }
      ASSERT_NEAR(sum, 1, 1e-6);
      error = std::max(error, (place - mesh.positions[v].cast<double>()).norm() / 2.5);
    }
    // Six points span space; what is left is the ridge's, 0.003 against weighted moments of a tenth. Fewer cannot.
    if (count >= 6) {
      EXPECT_LT(error, 0.05) << count;
    }
    if (count == 1) {
      EXPECT_GT(error, 0.9);
    }
  }
}

TEST(LocalLight, ContributionsOfOddMeshesAreFinite) {
  TriangleMesh flat = shapes::plane(1);  // four vertices in a plane, fewer than eight samples
  const IncidentSamples samples = place_incident_samples(flat, 8);
  EXPECT_EQ(samples.count(), 4);
  for (const float contribution : samples.contributions) EXPECT_TRUE(std::isfinite(contribution));
  for (Eigen::Vector3f& position : flat.positions) position *= 1e-20f;
  for (const float contribution : place_incident_samples(flat, 6).contributions)
    EXPECT_TRUE(std::isfinite(contribution));
}

/// Computes the relative L2 error of the exit radiance of an unshadowed sphere's vertices: `count` samples of incident
/// light against the light at every vertex itself, over balls in several directions, `distance` radii away.
double error_of_samples(int count, double distance) {
  const int bands = 5;
  const TriangleMesh mesh = shapes::icosphere(2);
  const IncidentSamples samples = place_incident_samples(mesh, count);
  const ShBasis basis(bands);
  double difference = 0, whole = 0;
  for (const Eigen::Vector3f& direction : shapes::icosphere(0).positions) {
    LightSpec ball{.kind = LightSpec::Kind::sphere, .radius = 0.05};
    for (int axis = 0; axis < 3; ++axis) ball.position[axis] = distance * direction[axis];
    const SceneLights lights{{ball}, std::nullopt, LightWindow::none};
    const AssetLight light = light_asset(lights, bands, {}, samples.points);
    for (std::size_t v = 0; v < mesh.positions.size(); ++v) {
      const std::vector<float> transfer = unoccluded_transfer(basis, mesh.positions[v].normalized());
      const double exact = dot_product(transfer, lights.incident(bands, mesh.positions[v].cast<double>()).channels[0]);
      double blended = 0;
      for (int k = 0; k < count; ++k)
        blended += samples.contributions[v * static_cast<std::size_t>(count) + k] *
                   dot_product(transfer, light.samples[static_cast<std::size_t>(k)].channels[0]);
      difference += (blended - exact) * (blended - exact);
      whole += exact * exact;
    }
  }
  return std::sqrt(difference / whole);
}

TEST(LocalLight, SamplesComeNearTheLightOfEveryPoint) {
  // One sample at the centre knows neither that the near side is brighter nor that light comes in at other angles
  // there. Linear interpolation leaves second derivatives of 1 / distance^2, which fall by distance squared: 4 times
  // farther away a sixteenth is left in theory; without it, a fourth.
  const double near = error_of_samples(6, 2), far = error_of_samples(6, 8);
  EXPECT_LT(near, 0.75 * error_of_samples(1, 2));
  EXPECT_LT(far, 0.2 * error_of_samples(1, 8));
  EXPECT_LT(far, 0.1 * near);
  EXPECT_LT(error_of_samples(8, 8), 0.2 * error_of_samples(1, 8));
}

TEST(LocalLight, GpuAndCpuAgree) {
  const Scratch scratch;
  const TriangleMesh mesh = shapes::plane(4);
  const auto context = software_context();
  for (const Shading shading : {Shading::forward, Shading::deferred})
    for (const int bits : {8, 16}) {
      write_asset(scratch.folder(), mesh, noise_stack(24, 20, 3, 1, bits));
      const PrtAsset asset = load_prt_asset(scratch.folder());
      const SceneLights lights = one_light("sphere:0.3,0.6,-0.2,0.1,1,0.7,0.4", LightWindow::hann);
      AssetRenderer renderer(asset, 6);
      SceneView view = small_view(asset.mesh, 10, 60);
      view.shading = shading;
      view.look.albedo = std::array{1.f, 0.6f, 0.3f};
      const Image<float> gpu = render_scene({{&renderer, {}, Technique::textured_prt}}, lights, view);

      // The CPU lights texels by each sample, blended by contributions that are linear over a triangle.
      const IncidentSamples& samples = renderer.samples();
      const AssetLight light = light_asset(lights, 3, {}, samples.points);
      std::vector<Image<float>> lit;
      for (const LightCoefficients& sample : light.samples)
        lit.push_back(relight_texels(asset, sample, *view.look.albedo));
      double largest = 0, brightest = 0;
      for (int j = 0; j < view.height; ++j)
        for (int i = 0; i < view.width; ++i) {
          const Eigen::Vector3f ray = view.camera.pixel_direction(i, j, view.width, view.height);
          const Eigen::Vector3f point = view.camera.position - view.camera.position.y() / ray.y() * ray;
          if (std::max(std::abs(point.x()), std::abs(point.z())) > 0.495f) continue;
          // The square's cell and, in it, the triangle: shapes::plane cuts along the rising diagonal.
          const auto vertex = [&](int column, int row) {
            for (std::size_t v = 0; v < asset.mesh.positions.size(); ++v)
              if ((asset.mesh.positions[v] -
                   Eigen::Vector3f(static_cast<float>(column) / 4 - 0.5f, 0, 0.5f - static_cast<float>(row) / 4))
                      .norm() < 0.01f)
                return v;
            return std::size_t{0};
          };
          const float s = 4 * (point.x() + 0.5f), t = 4 * (0.5f - point.z());
          const int column = static_cast<int>(s), row = static_cast<int>(t);
          const float u = s - static_cast<float>(column), v = t - static_cast<float>(row);
          const std::array<std::size_t, 3> corners = {vertex(column, row), vertex(column + 1, row + 1),
                                                      u > v ? vertex(column + 1, row) : vertex(column, row + 1)};
          const std::array<float, 3> shares = {1 - std::max(u, v), std::min(u, v), std::abs(u - v)};
          const float x = (0.1f + 0.8f * (point.x() + 0.5f)) * 24 - 0.5f,
                      y = (0.1f + 0.8f * (0.5f - point.z())) * 20 - 0.5f;
          const int left = static_cast<int>(x), low = static_cast<int>(y);
          const float a = x - static_cast<float>(left), b = y - static_cast<float>(low);
          for (int c = 0; c < 3; ++c) {
            // Denominator of the error: contributions may be below 0, so that the sum can be less than its parts.
            float expected = 0;
            for (int k = 0; k < samples.count(); ++k) {
              float contribution = 0;
              for (std::size_t corner = 0; corner < 3; ++corner)
                contribution += shares[corner] *
                                samples.contributions[corners[corner] * static_cast<std::size_t>(samples.count()) + k];
              const Image<float>& texels = lit[static_cast<std::size_t>(k)];
              brightest = std::max<double>(brightest, std::abs(texels.at(left, low, c)));
              expected +=
                  contribution * ((1 - b) * ((1 - a) * texels.at(left, low, c) + a * texels.at(left + 1, low, c)) +
                                  b * ((1 - a) * texels.at(left, low + 1, c) + a * texels.at(left + 1, low + 1, c)));
            }
            largest = std::max<double>(largest, std::abs(expected - gpu.at(i, j, c)));
          }
        }
      // A software renderer filters 8-bit textures in 8 bits, half a step off in each plane; deferred shading keeps
      // contributions in 16-bit floats, 11 bits of each. With 16 bits, twice what one sample is given
      // (Relight.GpuAndCpuAgree): contributions of both signs add up to more than 1.
      EXPECT_LT(largest, (bits == 8 ? 0.01 : shading == Shading::deferred ? 1e-3 : 2e-4) * brightest) << bits;
    }
}

TEST(LocalLight, PlacedAssetsAreLitAsTheSceneHasIt) {
  // A turned, moved and scaled sphere in the light of a ball looks as one that stands at the origin and has the light
  // turned, moved and scaled the other way.
  const Scratch scratch;
  const TriangleMesh mesh = shapes::cube_sphere(8);
  const auto context = software_context();
  write_asset(scratch.folder(), mesh, unoccluded_stack(mesh, 48, 32, 4, 16));
  const PrtAsset asset = load_prt_asset(scratch.folder());
  const Placement placement = parse_placement("place", "1,-2,0.5,70,3");
  const std::vector<Eigen::Vector3f> points = place_incident_samples(mesh, 6).points;
  const SceneLights placed{
      {parse_light_spec("sphere:4,3,-1,0.5"), parse_light_spec("30,20,0.3,0.4,0.5")}, std::nullopt, LightWindow::hann};
  const AssetLight light = light_asset(placed, 4, placement, points);
  for (std::size_t k = 0; k < points.size(); ++k) {
    const Eigen::Vector3d viewpoint = placement.to_scene(points[k].cast<double>());
    const LightCoefficients scene = placed.incident(4, viewpoint);
    for (const Eigen::Vector3d& direction :
         {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.6, 0, -0.8), Eigen::Vector3d(0, 1, 0)}) {
      const Eigen::Vector3d in_scene = placement.rotation * direction;
      EXPECT_NEAR(evaluate_at(light.samples[k].channels[1], direction.cast<float>()),
                  evaluate_at(scene.channels[1], in_scene.cast<float>()), 1e-4);
    }
  }
  // The direct light of the ball, too, for shading without harmonics.
  const Eigen::Vector3d back = placement.to_scene(light.direct[0].place.cast<double>());
  EXPECT_LT((back - Eigen::Vector3d(4, 3, -1)).norm(), 1e-5);
  EXPECT_NEAR(light.direct[0].radius, 0.5 / 3, 1e-6);
}

TEST(LocalLight, ProbesStandBetweenTheLightAndTheAsset) {
  // One probe lets light through as it is, the other half of it; a turned asset sees it turned.
  const int bands = 3;
  ProbeSet probes;
  probes.bands = bands;
  probes.grid = ProbeGrid{{2, 1, 1}, {0, 0, 0}, {2, 0, 0}};
  for (std::size_t k = 0; k < 2; ++k) {
    probes.positions.push_back(probes.grid->position(k));
    probes.valid.push_back(1);
    for (int i = 0; i < 9; ++i)
      for (int j = 0; j < 9; ++j) probes.matrices.push_back(i == j ? (k == 0 ? 1.f : 0.5f) : 0.f);
  }
  SceneLights lights = one_light("40,20,1,0.5,0.25", LightWindow::hann);
  const LightCoefficients far_away = lights.incident(bands, {0, 0, 0});
  lights.probes = &probes;
  EXPECT_TRUE(lights.is_local());
  const Placement placement = parse_placement("place", "1,0,0,90");
  const std::vector<Eigen::Vector3f> points = {{0, 0, -1}, {0, 0, 0}, {0, 0, 1}};  // in the scene x = 0, 1 and 2
  const AssetLight light = light_asset(lights, bands, placement, points);
  const ShRotation into_object(bands, placement.rotation.transpose());
  const LightCoefficients turned = into_object(far_away);
  const double shares[3] = {1, 0.75, 0.5};
  for (std::size_t k = 0; k < 3; ++k)
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t i = 0; i < 9; ++i)
        EXPECT_NEAR(light.samples[k].channels[c][i], shares[k] * turned.channels[c][i], 1e-5);
}

TEST(Placement, ReadsAndRefuses) {
  const Placement placement = parse_placement("place", "1,2,3,90,2");
  // +Z turns towards +X.
  EXPECT_LT((placement.to_scene({0, 0, 1}) - Eigen::Vector3d(3, 2, 3)).norm(), 1e-12);
  EXPECT_LT((placement.to_object(placement.to_scene({4, 5, 6})) - Eigen::Vector3d(4, 5, 6)).norm(), 1e-12);
  for (const char* text : {"", "1,2", "1,2,3,4,5,6", "a,b,c", "1,2,3,0,0", "1,2,3,0,-1"})
    EXPECT_THROW(parse_placement("place", text), WrongUsage) << text;
}

}  // namespace test_local_lights
}  // namespace kiln
