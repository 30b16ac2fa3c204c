// SPDX-License-Identifier: GPL-3.0-or-later
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "runtime/light/scene_lights.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_spec.h"
#include "sh/windows.h"

namespace kiln {
namespace test_light_windows {

constexpr std::array windows = {LightWindow::none, LightWindow::hann, LightWindow::lanczos, LightWindow::dering};

/// Computes the exit radiance of an unshadowed white surface, red.
double radiance(const LightCoefficients& light, const Eigen::Vector3f& normal) {
  return dot_product(light.channels[0], unoccluded_transfer(ShBasis(light.bands), normal));
}

TEST(LightWindows, SurfaceThatFacesALightHasTheRadianceItSays) {
  const Eigen::Vector3f axis = direction_from_angles(40, -25);
  for (const LightWindow window : windows)
    for (int bands = 1; bands <= 10; ++bands)
      for (const char* text : {"40,-25", "cone:40,-25,3", "cone:40,-25,30", "cone:40,-25,90", "cone:40,-25,140"}) {
        const LightCoefficients light = windowed_light(parse_light_spec(text), bands, window);
        // Coefficients are floats.
        EXPECT_NEAR(radiance(light, axis), 1, 1e-5) << text << ", window " << static_cast<int>(window) << ", " << bands;
      }
}

TEST(LightWindows, BallsFallWithTheSquareOfTheDistance) {
  for (const LightWindow window : windows)
    for (int bands = 1; bands <= 10; ++bands) {
      const LightSpec ball = parse_light_spec("sphere:0,0,4,1,0.5,1,1");
      for (const double z : {-4.0, 0.0, 2.0}) {
        const double expected = 0.5 * 16 / ((4 - z) * (4 - z));
        EXPECT_NEAR(radiance(windowed_light(ball, bands, window, {0, 0, z}), Eigen::Vector3f::UnitZ()), expected,
                    1e-5 * expected)
            << static_cast<int>(window) << ", " << bands;
      }
      // Light comes from everywhere inside: 16 times 0.5.
      EXPECT_NEAR(radiance(windowed_light(ball, bands, window, {0, 0, 3.5}), -Eigen::Vector3f::UnitY()), 8, 1e-4);
    }
}

TEST(LightWindows, FurnaceAndHemisphereStayWhatTheyAre) {
  const Eigen::Vector3f up = direction_from_angles(0, 90);
  for (const LightWindow window : windows)
    for (int bands = 1; bands <= 10; ++bands)
      for (const char* text : {"ambient:1", "cone:10,20,180"})
        for (const Eigen::Vector3f& normal : sample_directions(Sampling::fibonacci, 10, 1))
          EXPECT_NEAR(radiance(windowed_light(parse_light_spec(text), bands, window), normal), 1, 1e-5) << text;
  // The clamped cosine keeps two thirds of band 1: 1/2 + 1/3 up, 1/2 - 1/3 down.
  for (const LightWindow window : windows)
    for (int bands = 2; bands <= 10; ++bands) {
      const LightCoefficients sky = windowed_light(parse_light_spec("hemisphere:0,90,1,1,1,0,0,0"), bands, window);
      EXPECT_NEAR(radiance(sky, up), 5. / 6, 1e-5);
      EXPECT_NEAR(radiance(sky, -up), 1. / 6, 1e-5);
    }
}

TEST(LightWindows, EvenEnvironmentIsAFurnace) {
  for (const LightWindow window : windows)
    for (int bands = 1; bands <= 10; ++bands) {
      SceneLights lights{{}, constant_light(std::max(3, bands), std::array<float, 3>{1, 1, 1}), window};
      const LightCoefficients light = lights.incident(bands, {0, 0, 0});
      for (const Eigen::Vector3f& normal : sample_directions(Sampling::fibonacci, 10, 1))
        EXPECT_NEAR(radiance(light, normal), 1, 1e-5);
    }
}

TEST(LightWindows, LightIsASum) {
  const auto incident = [](const std::vector<LightSpec>& specs, LightWindow window) {
    return SceneLights{specs, std::nullopt, window}.incident(5, {1, 2, 3});
  };
  const LightSpec one = parse_light_spec("45,30"), other = parse_light_spec("sphere:3,1,1,0.5,1,0.5,0.2");
  for (const LightWindow window : windows) {
    const LightCoefficients both = incident({one, other}, window),
                            sum = add_lights(incident({one}, window), incident({other}, window));
    for (std::size_t i = 0; i < 25; ++i) EXPECT_NEAR(both.channels[1][i], sum.channels[1][i], 1e-5);
  }
}

TEST(LightWindows, DeringingOnAMeridianIsTheOneOnTheSphere) {
  const Eigen::Vector3f axis = direction_from_angles(-70, 15);
  for (const int bands : {2, 4, 7})
    for (const double half_angle : {0.0, 0.5, 2.0}) {
      const std::vector<double> general =
          deringing_window(cone_light(bands, axis, half_angle, std::array<float, 1>{1}));
      std::vector<double> axial = axial_weights(cone_bands(bands, half_angle), LightWindow::dering, 1);
      for (double& weight : axial) weight /= axial_weights(cone_bands(bands, half_angle), LightWindow::dering, 1)[0];
      // Both bisect to a thousandth of the strength; minima are looked for to 1e-6 of slightly other numbers.
      for (std::size_t l = 0; l < general.size(); ++l)
        EXPECT_NEAR(axial[l], general[l], 2e-3) << bands << ", " << half_angle;
    }
}

TEST(LightWindows, OfAPassedLightAreThoseOfTheBandsThatArrive) {
  // Probes past which light comes as it is, of fewer and of more bands than the asset.
  for (const int probe_bands : {2, 3, 5}) {
    ProbeSet probes;
    probes.bands = probe_bands;
    probes.positions.emplace_back(0, 0, 0);
    probes.valid.push_back(1);
    for (int i = 0; i < probe_bands * probe_bands; ++i)
      for (int j = 0; j < probe_bands * probe_bands; ++j) probes.matrices.push_back(i == j ? 1.f : 0.f);
    SceneLights lights{{parse_light_spec("40,-25")}, std::nullopt, LightWindow::hann};
    lights.probes = &probes;
    const LightCoefficients light = lights.incident(3, {0, 0, 0});
    EXPECT_NEAR(radiance(light, direction_from_angles(40, -25)), 1, 1e-5) << probe_bands;
  }
}

}  // namespace test_light_windows
}  // namespace kiln
