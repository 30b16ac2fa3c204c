// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

#include "base/errors.h"
#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/light_spec.h"
#include "sh/lights.h"
#include "sh/product.h"
#include "sh/quadrature.h"
#include "sh/rotation.h"
#include "sh/windows.h"

namespace kiln {
namespace test_sh_functions {

constexpr std::array<float, 1> white = {1};

std::vector<float> random_function(int bands, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> number(-1, 1);
  std::vector<float> function(coefficient_count(bands));
  for (float& value : function) value = number(random);
  return function;
}

/// Lists rotations by angles and axes with and without symmetry.
std::vector<Eigen::Matrix3d> rotations() {
  std::vector<Eigen::Matrix3d> all = {Eigen::Matrix3d::Identity()};
  for (int axis = 0; axis < 3; ++axis)
    for (const double angle : {0.5 * std::numbers::pi, std::numbers::pi})
      all.push_back(Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix());
  for (const double angle : {0.3, 1.7, 3.0})
    all.push_back(Eigen::AngleAxisd(angle, Eigen::Vector3d(1, -2, 0.5).normalized()).toRotationMatrix());
  return all;
}

TEST(ShRotation, RotatedFunctionHasTheValueOfTheFunctionBefore) {
  const std::vector<float> function = random_function(24, 1);
  const std::vector<Eigen::Vector3f> directions = sample_directions(Sampling::fibonacci, 50, 1);
  for (const Eigen::Matrix3d& rotation : rotations()) {
    const std::vector<float> rotated = ShRotation(24, rotation)(function);
    for (const Eigen::Vector3f& direction : directions) {
      const double there = evaluate_at(rotated, (rotation * direction.cast<double>()).cast<float>());
      // 576 coefficients of up to 1 in float32, times basis functions of up to 2: roundings of 1e-7 add up to 1e-4.
      EXPECT_NEAR(there, evaluate_at(function, direction), 1e-4);
    }
  }
}

TEST(ShRotation, MatricesAreOrthogonalAtEveryOrder) {
  const ShRotation rotation(24, Eigen::AngleAxisd(2.1, Eigen::Vector3d(0.2, 1, -0.7).normalized()).toRotationMatrix());
  for (int l = 0; l < 24; ++l) {
    const Eigen::MatrixXd& band = rotation.band(l);
    EXPECT_LT((band * band.transpose() - Eigen::MatrixXd::Identity(2 * l + 1, 2 * l + 1)).cwiseAbs().maxCoeff(), 1e-12)
        << "band " << l;
  }
}

TEST(ShRotation, FollowOneAnother) {
  const Eigen::Matrix3d first = rotations()[8], second = rotations()[9];
  const std::vector<float> function = random_function(8, 2);
  const std::vector<float> in_turn = ShRotation(8, second)(ShRotation(8, first)(function));
  const std::vector<float> at_once = ShRotation(8, second * first)(function);
  for (std::size_t i = 0; i < function.size(); ++i) EXPECT_NEAR(in_turn[i], at_once[i], 1e-6);
}

TEST(ShRotation, TurnsALightToWhereItPoints) {
  const Eigen::Matrix3d rotation = rotations()[7];
  const Eigen::Vector3f before = Eigen::Vector3f(0.3f, 0.8f, -0.4f).normalized();
  const LightCoefficients turned = ShRotation(6, rotation)(directional_light(6, before, white));
  const LightCoefficients wanted = directional_light(6, (rotation * before.cast<double>()).cast<float>(), white);
  for (std::size_t i = 0; i < 36; ++i) EXPECT_NEAR(turned.channels[0][i], wanted.channels[0][i], 2e-6);
}

TEST(ShRotation, RefusesWhatIsNoRotation) {
  EXPECT_THROW(ShRotation(3, 2 * Eigen::Matrix3d::Identity()), std::invalid_argument);
  EXPECT_THROW(ShRotation(3, Eigen::Vector3d(1, 1, -1).asDiagonal().toDenseMatrix()), std::invalid_argument);
  EXPECT_THROW(ShRotation(3, Eigen::Matrix3d::Constant(std::nan(""))), std::invalid_argument);
}

/// Projects the product of both functions' values, by a quadrature that is exact for it.
TEST(ShProduct, IsTheProjectionOfTheProductOfValues) {
  for (int bands = 1; bands <= 6; ++bands) {
    const std::vector<float> f = random_function(bands, 3), g = random_function(bands, 4);
    const ShBasis basis(bands);
    const SphereQuadrature quadrature = exact_quadrature(3 * (bands - 1) + 5);  // not the one it was computed with
    std::vector<double> values(basis.size()), wanted(basis.size(), 0.0);
    for (std::size_t s = 0; s < quadrature.directions.size(); ++s) {
      basis.evaluate<double>(quadrature.directions[s], values);
      double f_there = 0, g_there = 0;
      for (int i = 0; i < basis.size(); ++i) {
        f_there += f[i] * values[i];
        g_there += g[i] * values[i];
      }
      for (int i = 0; i < basis.size(); ++i) wanted[i] += quadrature.weights[s] * f_there * g_there * values[i];
    }
    const std::vector<float> product = ShProduct::of_bands(bands)(f, g);
    for (int i = 0; i < basis.size(); ++i) EXPECT_NEAR(product[i], wanted[i], 1e-5) << bands << " bands, " << i;
  }
}

TEST(ShProduct, HasTheKnownTriples) {
  const ShProduct& product = ShProduct::of_bands(3);
  const double y0 = std::sqrt(1 / (4 * std::numbers::pi));
  EXPECT_NEAR(product.triple(0, 0, 0), y0, 1e-14);
  EXPECT_NEAR(product.triple(5, 0, 5), y0, 1e-14);             // orthonormality
  EXPECT_NEAR(product.triple(2, 2, 6), 0.252313, 1e-6);        // z, z and 3z^2 - 1: 1 / sqrt(5 pi)
  EXPECT_EQ(product.triple(1, 2, 3), 0);                       // odd in each axis
  EXPECT_LT(ShProduct::of_bands(6).nonzero_triples(), 1000u);  // of 8,436: sparse
}

/// Compares all triples with a quadrature of a higher degree, whose places are others.
TEST(ShProduct, TriplesAgreeWithExactQuadrature) {
  for (int bands = 3; bands <= 10; ++bands) {
    const ShProduct& product = ShProduct::of_bands(bands);
    const ShBasis basis(bands);
    const SphereQuadrature quadrature = exact_quadrature(3 * (bands - 1) + 4);
    const Eigen::Index size = basis.size(), places = static_cast<Eigen::Index>(quadrature.directions.size());
    Eigen::MatrixXd values(size, places);
    std::vector<double> there(basis.size());
    for (Eigen::Index s = 0; s < places; ++s) {
      basis.evaluate<double>(quadrature.directions[static_cast<std::size_t>(s)], there);
      values.col(s) = Eigen::Map<const Eigen::VectorXd>(there.data(), size);
    }
    const Eigen::Map<const Eigen::ArrayXd> weights(quadrature.weights.data(), places);
    double largest = 0;
    for (Eigen::Index i = 0; i < size; ++i) {
      const Eigen::MatrixXd weighted = values.array().rowwise() * (values.row(i).array() * weights.transpose());
      const Eigen::MatrixXd wanted = weighted * values.transpose();
      for (Eigen::Index j = i; j < size; ++j)
        for (Eigen::Index k = j; k < size; ++k)
          largest = std::max(largest, std::abs(wanted(j, k) - product.triple(static_cast<int>(i), static_cast<int>(j),
                                                                             static_cast<int>(k))));
    }
    EXPECT_LT(largest, 1e-10) << bands << " bands";
  }
}

/// Band l of a product takes no band of the second factor above l plus the first's bands: nine bands of both are exact
/// for five of the result where one has five.
TEST(ShProduct, OfManyBandsIsExactInTheFirst) {
  const ShProduct &product = ShProduct::of_bands(9, 5), &whole = ShProduct::of_bands(14);
  const std::vector<float> g = random_function(14, 9);
  std::vector<float> f = random_function(5, 8), g_cut(g.begin(), g.begin() + 81), f_long = f;
  f.resize(81);
  f_long.resize(14 * 14);
  const std::vector<float> cut = product(f, g_cut), exact = whole(f_long, g);
  ASSERT_EQ(cut.size(), 25u);
  for (std::size_t i = 0; i < cut.size(); ++i) EXPECT_NEAR(cut[i], exact[i], 1e-5) << i;
  EXPECT_GT(std::abs(ShProduct::of_bands(5)(std::span(f).first(25), std::span(g).first(25))[20] - exact[20]), 1e-3);
}

TEST(ShProduct, WithOneChangesNothing) {
  const std::vector<float> f = random_function(5, 6);
  const LightCoefficients one = constant_light(5, white);
  const std::vector<float> product = ShProduct::of_bands(5)(one.channels[0], f);
  for (std::size_t i = 0; i < f.size(); ++i) EXPECT_NEAR(product[i], f[i], 1e-6);
}

/// Computes a function's coefficients by dense quadrature; discontinuities converge as the distance between directions.
template <class Function>
std::vector<double> projected(int bands, const Function& function) {
  const ShBasis basis(bands);
  constexpr int count = 400'000;
  std::vector<double> values(basis.size()), sums(basis.size(), 0.0);
  for (const Eigen::Vector3f& direction : sample_directions(Sampling::fibonacci, count, 5)) {
    basis.evaluate<double>(direction.cast<double>(), values);
    const double value = function(direction) * 4 * std::numbers::pi / count;
    for (int i = 0; i < basis.size(); ++i) sums[i] += value * values[i];
  }
  return sums;
}

TEST(ShLights, ConeIsTheProjectionOfItsCap) {
  const Eigen::Vector3f axis = Eigen::Vector3f(0.2f, 0.5f, 0.9f).normalized();
  for (const double half_angle : {0.1, 0.6, 1.4, 2.5}) {
    const double cosine = std::cos(half_angle), radiance = cosine > 0 ? 1 / (1 - cosine * cosine) : 1;
    const LightCoefficients light = cone_light(8, axis, half_angle, white);
    const std::vector<double> wanted =
        projected(8, [&](const Eigen::Vector3f& s) { return s.dot(axis) > cosine ? radiance : 0; });
    // The least cap holds a thousand of the directions, of which two in a thousand are on the wrong side of its rim.
    for (std::size_t i = 0; i < 64; ++i) EXPECT_NEAR(light.channels[0][i], wanted[i], 6e-3) << half_angle << ", " << i;
  }
}

TEST(ShLights, WhiteSurfaceThatFacesItHasRadianceOne) {
  const Eigen::Vector3f axis = Eigen::Vector3f(-0.3f, 0.7f, 0.1f).normalized();
  // Band 24 holds what is left of a clamped cosine times a light: 1e-4.
  const auto facing = [&](const LightCoefficients& light) {
    return dot_product(light.channels[0], unoccluded_transfer(ShBasis(light.bands), axis));
  };
  EXPECT_NEAR(facing(cone_light(24, axis, 0.3, white)), 1, 1e-3);
  EXPECT_NEAR(facing(sphere_light(24, 3 * axis, 1, white)), 1, 1e-3);
  EXPECT_NEAR(facing(sphere_light(24, 0.5f * axis, 1, white)), 1, 1e-5);  // inside it
  EXPECT_NEAR(facing(hemisphere_light(24, axis, white, std::array<float, 1>{0})), 0.5 + 1. / 3, 1e-5);
}

TEST(ShLights, ThinConeIsADirectionalLight) {
  const Eigen::Vector3f axis = Eigen::Vector3f(0.6f, -0.2f, 0.5f).normalized();
  const LightCoefficients point = directional_light(24, axis, white);
  for (const double half_angle : {0.0, 0.999e-3, 1.001e-3}) {
    const LightCoefficients cone = cone_light(24, axis, half_angle, white);
    // In band 23 a cone of 1/1000 radian loses 1.5e-4 of at most 6.
    for (std::size_t i = 0; i < 576; ++i) EXPECT_NEAR(cone.channels[0][i], point.channels[0][i], 2e-3);
  }
}

TEST(ShLights, HemisphereGoesFromGroundToSky) {
  const Eigen::Vector3f up = Eigen::Vector3f(0.1f, 0.9f, 0.3f).normalized();
  const LightCoefficients light =
      hemisphere_light(4, up, std::array<float, 2>{1, 0.25f}, std::array<float, 2>{0.5f, 2});
  EXPECT_NEAR(evaluate_at(light.channels[0], up), 1, 1e-6);
  EXPECT_NEAR(evaluate_at(light.channels[0], -up), 0.5, 1e-6);
  EXPECT_NEAR(evaluate_at(light.channels[1], up.unitOrthogonal()), 0.5 * (0.25 + 2), 1e-6);
}

TEST(ShLights, CubeMapOfAFunctionIsTheFunction) {
  // A cube map filled with a band-limited function; each face's texel points where OpenGL's table says.
  const std::vector<float> function = random_function(4, 9);
  constexpr int size = 64;
  const auto direction = [](int face, double s, double t) -> Eigen::Vector3d {
    switch (face) {
      case 0:
        return {1, -t, -s};
      case 1:
        return {-1, -t, s};
      case 2:
        return {s, 1, t};
      case 3:
        return {s, -1, -t};
      case 4:
        return {s, -t, 1};
      default:
        return {-s, -t, -1};
    }
  };
  std::array<std::vector<float>, 6> texels;
  std::array<std::span<const float>, 6> faces;
  for (int face = 0; face < 6; ++face) {
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i)
        texels[face].push_back(static_cast<float>(evaluate_at(
            function, direction(face, 2 * (i + 0.5) / size - 1, 2 * (j + 0.5) / size - 1).normalized().cast<float>())));
    faces[face] = texels[face];
  }
  const LightCoefficients light = cube_map_light(4, size, 1, faces);
  // Looked up at texel centres: second order in 1/64 of a quarter turn.
  for (std::size_t i = 0; i < function.size(); ++i) EXPECT_NEAR(light.channels[0][i], function[i], 2e-3);
}

TEST(ShLights, CubeMapOfOneIsTheConstantLight) {
  const std::vector<float> ones(25 * 3, 1.f);
  std::array<std::span<const float>, 6> faces;
  faces.fill(ones);
  const LightCoefficients light = cube_map_light(3, 5, 3, faces);
  ASSERT_EQ(light.channels.size(), 3u);
  // Solid angles are exact, so band 0 is; bands 1 and 2 vanish by the cube's symmetry.
  for (std::size_t i = 0; i < 9; ++i) EXPECT_NEAR(light.channels[2][i], i == 0 ? 3.5449077 : 0, 1e-6);
}

TEST(ShLights, IrradianceIsTheClampedCosineIntegral) {
  const LightCoefficients light = cone_light(24, Eigen::Vector3f::UnitY(), 0.4, white);
  const LightCoefficients received = irradiance(light);
  for (const Eigen::Vector3f& normal : sample_directions(Sampling::fibonacci, 20, 3))
    EXPECT_NEAR(evaluate_at(received.channels[0], normal) / std::numbers::pi,
                dot_product(light.channels[0], unoccluded_transfer(ShBasis(24), normal)), 1e-5);
  const LightCoefficients doubled = scale_light(add_lights(light, light), 0.5);
  EXPECT_EQ(doubled.channels, light.channels);
}

/// Measures how far sums over directions are from orthonormality of the basis: the largest eigenvalue of G - 1, where G
/// is the Gram matrix.
double gram_error(Sampling sampling, int count, int bands) {
  const ShBasis basis(bands);
  Eigen::MatrixXd values(basis.size(), count);
  std::vector<double> column(basis.size());
  const std::vector<Eigen::Vector3f> directions = sample_directions(sampling, count, 1);
  for (int k = 0; k < count; ++k) {
    basis.evaluate<double>(directions[k].cast<double>().normalized(), column);
    values.col(k) = Eigen::Map<const Eigen::VectorXd>(column.data(), basis.size());
  }
  const Eigen::MatrixXd error = values * values.transpose() * (4 * std::numbers::pi / count) -
                                Eigen::MatrixXd::Identity(basis.size(), basis.size());
  return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(error, Eigen::EigenvaluesOnly)
      .eigenvalues()
      .cwiseAbs()
      .maxCoeff();
}

TEST(Directions, AsManyAsBandsNeedKeepTheirFunctionsApart) {
  for (const Sampling sampling : {Sampling::fibonacci, Sampling::progressive, Sampling::stratified})
    for (const int bands : {2, 4, 5, 8, 10}) {
      const auto count = static_cast<int>(directions_for_bands(sampling, bands));
      // Allow a tenth, and a third more for the luck of one seed.
      EXPECT_LT(gram_error(sampling, count, bands), 0.13) << static_cast<int>(sampling) << ", " << bands;
      // A quarter of as many are too few, but for powers of two of progressive ones, which are whole lattices.
      if (sampling != Sampling::progressive) {
        EXPECT_GT(gram_error(sampling, count / 4, bands), 0.13) << static_cast<int>(sampling) << ", " << bands;
      }
    }
}

TEST(ShWindows, DeringingLeavesNothingNegativeAndNoMoreThanNeeded) {
  for (const int bands : {2, 3, 5, 8}) {
    LightCoefficients light =
        directional_light(bands, Eigen::Vector3f(1, 2, 3).normalized(), std::array<float, 2>{1, 0.3f});
    ASSERT_LT(smallest_value(light.channels[0]), -0.1);
    const LightCoefficients before = light;
    const std::vector<double> window = deringing_window(light);
    apply_window(light, window);
    // A minimum is followed down to 1e-6 of the largest coefficient, which is near 5; and bisection stops at 0.1 %.
    for (const std::vector<float>& channel : light.channels) EXPECT_NEAR(smallest_value(channel), 0, 3e-3) << bands;
    // A hundredth less of it would ring: the family is 1 / (1 + strength l^2 (l + 1)^2).
    const double strength = 0.99 * (1 / window[1] - 1) / 4;
    LightCoefficients weaker = before;
    std::vector<double> weaker_window;
    for (int l = 0; l < bands; ++l) weaker_window.push_back(1 / (1 + strength * l * l * (l + 1) * (l + 1)));
    apply_window(weaker, weaker_window);
    EXPECT_LT(smallest_value(weaker.channels[0]), -1e-4) << bands;
    EXPECT_FLOAT_EQ(light.channels[0][0], before.channels[0][0]);
  }
}

TEST(ShWindows, DeringingLeavesWhatDoesNotRing) {
  const LightCoefficients soft = hemisphere_light(5, Eigen::Vector3f::UnitY(), white, std::array<float, 1>{0.1f});
  EXPECT_EQ(deringing_window(soft), std::vector<double>(5, 1.0));
  const LightCoefficients dark = scale_light(soft, -1);
  EXPECT_EQ(deringing_window(dark), std::vector<double>(5, 1.0));
  const LightCoefficients none = scale_light(soft, 0);
  EXPECT_EQ(deringing_window(none), std::vector<double>(5, 1.0));
}

TEST(ShWindows, SmallestValueOfAKnownFunction) {
  // 3z^2 - 1 times sqrt(5 / 16 pi): least on the equator.
  std::vector<float> function(9, 0.f);
  function[6] = 1;
  EXPECT_NEAR(smallest_value(function), -std::sqrt(5 / (16 * std::numbers::pi)), 1e-6);
}

TEST(ShWindows, LanczosIsTheSampledSinc) {
  const std::vector<double> window = lanczos_window(4);
  EXPECT_EQ(window[0], 1);
  EXPECT_NEAR(window[2], 2 / std::numbers::pi, 1e-12);
  for (int l = 1; l < 4; ++l) EXPECT_LT(window[l], window[l - 1]);
}

TEST(LightSpecs, EveryKindIsReadAsItIsWritten) {
  for (const char* text : {"directional:10,20,1,0.5,0.25", "cone:-30,60,15,1,1,2", "sphere:1,-2,3.5,0.5,2,2,2",
                           "hemisphere:0,90,0.5,0.75,1,0.25,0.125,0", "ambient:0.5,1,2"}) {
    const LightSpec spec = parse_light_spec(text);
    EXPECT_EQ(to_text(spec), text);
    EXPECT_EQ(light_coefficients(spec, 4).channels.size(), 3u);
  }
  EXPECT_EQ(to_text(parse_light_spec("45,30")), "directional:45,30,1,1,1");
  EXPECT_EQ(to_text(parse_light_spec("cone:0,0,5")), "cone:0,0,5,1,1,1");
}

TEST(LightSpecs, WrongOnesAreRefused) {
  for (const char* text :
       {"", "45", "torch:1,2", "cone:1,2", "cone:1,2,181", "sphere:0,0,0,0", "sphere:1,2,3", "hemisphere:0,90",
        "hemisphere:0,90,1,1,1", "ambient:-1", "45,91", "361,0", "0,0,1,-1,1", "sphere:1,2,3,1,1,1,nan"})
    EXPECT_THROW(parse_light_spec(text), WrongUsage) << text;
}

TEST(LightSpecs, NumbersOutOfRangeAreRefusedInAStructToo) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  check_light_spec({});
  const auto expect_refused = [](const auto& spoil) {
    LightSpec spec;
    spoil(spec);
    EXPECT_THROW(check_light_spec(spec), WrongUsage) << to_text(spec);
  };
  expect_refused([](LightSpec& spec) { spec.elevation_degrees = 90.5; });
  expect_refused([](LightSpec& spec) { spec.azimuth_degrees = nan; });
  expect_refused([](LightSpec& spec) { spec.color[1] = -1; });
  expect_refused([](LightSpec& spec) { spec.color[2] = 2e6f; });
  expect_refused([](LightSpec& spec) { spec.color[0] = static_cast<float>(nan); });
  expect_refused([](LightSpec& spec) { spec.kind = LightSpec::Kind::cone, spec.half_angle_degrees = 181; });
  expect_refused([](LightSpec& spec) { spec.kind = LightSpec::Kind::sphere, spec.radius = 0; });
  expect_refused([](LightSpec& spec) { spec.kind = LightSpec::Kind::sphere, spec.position[2] = nan; });
}

}  // namespace test_sh_functions
}  // namespace kiln
