// SPDX-License-Identifier: GPL-3.0-or-later
#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

#include "spectra.h"
#include "spectrum/colorimetry.h"
#include "spectrum/optics.h"
#include "spectrum/rgb_lift.h"
#include "spectrum/spectral_error.h"
#include "spectrum/wavelengths.h"

namespace kiln {
namespace test_spectral_basis {

/// Six lamps of different kinds.
const std::vector<std::string> six_lamps = {"A", "D50", "D65", "F2", "F7", "F11"};

TEST(SpectralBasis, SixFunctionsHoldSixLampsAndEightThreeReflections) {
  const SpectralScene scene = scene_of_lights(six_lamps);
  const BasisFinder finder(scene);
  const auto direct = reflection_chains(15, 1), third = reflection_chains(15, 3);
  ASSERT_EQ(third.size(), 680u);
  for (int m = 3; m <= 8; ++m) {
    const ColorErrors once = basis_errors(scene, finder.characteristic(m), direct);
    const ColorErrors thrice = basis_errors(scene, finder.characteristic(m), third);
    if (m == 6) {
      EXPECT_LT(once.mean, 0.19);
      EXPECT_LT(once.worst, 1.0);
      EXPECT_LT(thrice.mean, 0.65);
    }
    if (m == 8) {
      EXPECT_LT(once.worst, 0.17);
      EXPECT_LT(thrice.worst, 1.3);
    }
  }
  // Sixteen even wavelengths are worse than eight characteristic vectors: lamps have lines.
  EXPECT_GT(basis_errors(scene, finder.points(16), direct).worst, 1);

  const RgbLift lift{StandardSpectra()};
  const ColorErrors rgb = rgb_errors(scene, lift, direct), rgb_thrice = rgb_errors(scene, lift, third);
  EXPECT_GT(rgb.mean, 2.5);
  EXPECT_GT(rgb.worst, 8);
  EXPECT_GT(rgb_thrice.worst, 20);
}

TEST(SpectralBasis, AFewWavelengthsBounceByThemselves) {
  const SpectralScene scene = scene_of_lights({"D65", "A", "F11"});
  const WavelengthSet set = find_wavelengths(scene, 8);
  ASSERT_EQ(set.wavelengths_nm.size(), 8u);
  EXPECT_LT(wavelength_errors(scene, set, reflection_chains(15, 1)).worst, 1.3);
  EXPECT_LT(wavelength_errors(scene, set, reflection_chains(15, 3)).worst, 2.0);
  for (std::size_t l = 0; l < 3; ++l) {
    const Xyz white = set.readers[l].rowwise().sum();
    EXPECT_LT((white - xyz_of(scene.lights[l].values, scene.observer)).norm(), 1e-8);
  }
}

TEST(SpectralBasis, WhiteKeepsItsColorUnderEveryLamp) {
  const SpectralScene scene = scene_of_lights(six_lamps);
  const BasisFinder finder(scene);
  for (const SpectralBasis& basis :
       {finder.characteristic(3), finder.characteristic(6), finder.lights(), finder.points(16)})
    for (const NamedSpectrum& light : scene.lights) {
      const Xyz truth = xyz_of(light.values, scene.observer);
      const Eigen::VectorXd vector = light_vector(basis, light.values, scene.observer);
      EXPECT_LT((sensor_matrix(basis, scene.observer) * vector - truth).norm(), 1e-8) << basis.kind << light.name;
      const Eigen::MatrixXd white = surface_matrix(basis, flat_spectrum(1));
      EXPECT_LT((white * vector - vector).norm(), 1e-8 * vector.norm()) << basis.kind << light.name;
    }
}

TEST(SpectralBasis, WhatASurfaceSendsOutKeepsItsColorWhenItIsProjected) {
  const SpectralScene scene = scene_of_lights({"D65", "F11"});
  const SpectralBasis basis = BasisFinder(scene).characteristic(5);
  const Eigen::MatrixXd reader = sensor_matrix(basis, scene.observer);
  for (const NamedSpectrum& reflectance : scene.reflectances) {
    const Spectrum light = scene.lights[1].values * reflectance.values;
    EXPECT_LT((reader * (basis.duals.transpose() * light.matrix()) - xyz_of(light, scene.observer)).norm(), 1e-8);
  }
}

TEST(SpectralBasis, LampsAsBasisAreExactInDirectLight) {
  const SpectralScene scene = scene_of_lights({"A", "D65", "F11", "A"});
  const SpectralBasis basis = BasisFinder(scene).lights();
  EXPECT_EQ(basis.size(), 3);  // the second A is the first
  EXPECT_LT(basis_errors(scene, basis, reflection_chains(15, 1)).worst, 1e-6);
}

TEST(SpectralBasis, OneLampAndItsMaterialsMeetTheGoals) {
  for (const char* const lamp : {"A", "D65", "F2", "F10", "F11", "F12"}) {
    const SpectralScene scene = scene_of_lights({lamp});
    const BasisFinder finder(scene);
    EXPECT_LT(basis_errors(scene, finder.characteristic(6), reflection_chains(15, 1)).worst, 1.0) << lamp;
    EXPECT_LT(basis_errors(scene, finder.characteristic(8), reflection_chains(15, 3)).worst, 2.0) << lamp;
  }
}

TEST(SpectralBasis, AGreySceneHasOneFunction) {
  SpectralScene scene = scene_of_lights({"D65"});
  scene.reflectances = {{"grey", flat_spectrum(0.5)}};
  const BasisFinder finder(scene);
  EXPECT_EQ(finder.rank(), 1);
  const ColorErrors errors = basis_errors(scene, finder.characteristic(1), reflection_chains(1, 3));
  EXPECT_LT(errors.worst, 1e-6);
  for (const int size : {1, 3, 8})  // wavelengths that all say the same
    EXPECT_LT(wavelength_errors(scene, find_wavelengths(scene, size), reflection_chains(1, 3)).worst, 1e-4) << size;
}

TEST(SpectralBasis, MetamersSplitAsTheyDoInTruth) {
  // Two surfaces of one colour under D65: the second differs by a curve that D65 and the observer do not see.
  SpectralScene scene = scene_of_lights({"D65", "A", "F11"});
  const SpectrumMatrix seen = scene.lights[0].values.matrix().asDiagonal() * scene.observer;
  Eigen::VectorXd curve(wavelength_count);
  for (int i = 0; i < wavelength_count; ++i)
    curve(i) =
        std::exp(-std::pow((wavelength_nm(i) - 600) / 15, 2)) - std::exp(-std::pow((wavelength_nm(i) - 500) / 25, 2));
  SpectrumMatrix smooth(wavelength_count, 3);  // what restores the colour
  for (int i = 0; i < wavelength_count; ++i)
    for (int k = 0; k < 3; ++k) smooth(i, k) = std::exp(-std::pow((wavelength_nm(i) - 450 - 80 * k) / 60, 2));
  curve -= smooth * (seen.transpose() * smooth).inverse() * (seen.transpose() * curve);
  const Spectrum first = flat_spectrum(0.45), second = first + 0.4 * curve.array() / curve.cwiseAbs().maxCoeff();
  ASSERT_TRUE((second >= 0).all() && (second <= 1).all());
  scene.reflectances.push_back({"first", first});
  scene.reflectances.push_back({"second", second});

  const SpectralBasis basis = BasisFinder(scene).characteristic(6);
  const Eigen::MatrixXd reader = sensor_matrix(basis, scene.observer);
  for (const NamedSpectrum& light : scene.lights) {
    const Xyz white = xyz_of(light.values, scene.observer);
    const auto truth = [&](const Spectrum& r) { return lab_of(xyz_of(light.values * r, scene.observer), white); };
    const auto computed = [&](const Spectrum& r) {
      const Xyz xyz = reader * surface_matrix(basis, r) * light_vector(basis, light.values, scene.observer);
      return lab_of(xyz, white);
    };
    const double split = ciede2000(truth(first), truth(second));
    EXPECT_NEAR(ciede2000(computed(first), computed(second)), split, 0.5) << light.name;
    if (light.name == "D65")
      EXPECT_LT(split, 1e-6);
    else
      EXPECT_GT(split, 3) << light.name;
  }
  // Red, green and blue cannot tell them apart.
  const RgbLift lift{StandardSpectra()};
  EXPECT_LT((lift.albedo_of(first) - lift.albedo_of(second)).norm(), 1e-6);
}

TEST(SpectralBasis, ChainsAreAllCombinationsOrThinnedEvenly) {
  EXPECT_EQ(reflection_chains(3, 2), (std::vector<ReflectionChain>{{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}));
  // Combinations that are too many are thinned evenly: each surface is met about as often.
  const auto few = reflection_chains(100, 6, 10000);
  ASSERT_EQ(few.size(), 10000u);
  EXPECT_EQ(few[7], ReflectionChain(6, 7));
  std::vector<int> met(100, 0);
  for (const ReflectionChain& chain : few)
    for (const std::size_t surface : chain) ++met[surface];
  for (const int times : met) EXPECT_NEAR(times, 600, 60);
}

TEST(RgbLift, ColorsComeBackUnderDaylight) {
  const RgbLift lift{StandardSpectra()};
  for (int r = 0; r <= 4; ++r)
    for (int g = 0; g <= 4; ++g)
      for (int b = 0; b <= 4; ++b) {
        const Eigen::Vector3d albedo = Eigen::Vector3d(r, g, b) / 4;
        const Spectrum spectrum = lift.lift(albedo).spectrum();
        EXPECT_TRUE((spectrum >= 0).all() && (spectrum <= 1).all());
        EXPECT_LT((lift.albedo_of(spectrum) - albedo).cwiseAbs().maxCoeff(), 2e-5)
            << albedo.transpose() << " became " << lift.albedo_of(spectrum).transpose();
      }
  // Grey is flat, and a smooth red surface is lifted to nearly itself.
  const Spectrum grey = lift.lift({0.3, 0.3, 0.3}).spectrum();
  EXPECT_LT(grey.maxCoeff() - grey.minCoeff(), 1e-9);
}

TEST(Optics, FresnelHasItsClosedForms) {
  EXPECT_NEAR(fresnel_reflectance(1, 1.5).mean(), 0.04, 1e-12);
  const std::complex<double> gold(0.27, 2.95);
  EXPECT_NEAR(fresnel_reflectance(1, gold).mean(), std::norm((gold - 1.0) / (gold + 1.0)), 1e-12);
  const double brewster = std::atan(1.5);
  EXPECT_NEAR(fresnel_reflectance(std::cos(brewster), 1.5).parallel, 0, 1e-15);
  EXPECT_EQ(fresnel_reflectance(0, 1.5).mean(), 1);
  // The formula with angles, which the code does not use: sin^2(i - t) / sin^2(i + t) and tan^2 likewise.
  for (const double degrees : {10.0, 40.0, 75.0}) {
    const double i = degrees * std::numbers::pi / 180, t = std::asin(std::sin(i) / 1.33);
    const PolarisedReflectance share = fresnel_reflectance(std::cos(i), 1.33);
    EXPECT_NEAR(share.perpendicular, std::pow(std::sin(i - t) / std::sin(i + t), 2), 1e-12);
    EXPECT_NEAR(share.parallel, std::pow(std::tan(i - t) / std::tan(i + t), 2), 1e-12);
  }
}

TEST(Optics, FilmsHaveTheirClosedForms) {
  // A quarter of a wave of the index's root takes all reflection away; half a wave is as if it were not there.
  const ThinFilm coating{std::sqrt(1.5), 1.5, 550 / (4 * std::sqrt(1.5))};
  EXPECT_NEAR(film_reflectance(coating, 1, 550).mean(), 0, 1e-15);
  EXPECT_NEAR(film_reflectance({1.8, 1.5, 550 / (2 * 1.8)}, 1, 550).mean(), 0.04, 1e-12);
  EXPECT_NEAR(film_reflectance({1.33, 1.5, 0}, 0.5, 550).perpendicular, fresnel_reflectance(0.5, 1.5).perpendicular,
              1e-12);
  EXPECT_NEAR(film_reflectance({1.33, 1.5, 0}, 0.5, 550).parallel, fresnel_reflectance(0.5, 1.5).parallel, 1e-12);
  // A bubble without loss: 2 F (1 - cos) / (1 + F^2 - 2 F cos), with F the share that one face reflects.
  for (const double cosine : {1.0, 0.6, 0.2}) {
    const double f = fresnel_reflectance(cosine, 1.33).perpendicular;
    const double inside = std::sqrt(1 - (1 - cosine * cosine) / (1.33 * 1.33));
    const double phase = 4 * std::numbers::pi * 1.33 * 420 * inside / 600;
    EXPECT_NEAR(film_reflectance({1.33, 1, 420}, cosine, 600).perpendicular,
                2 * f * (1 - std::cos(phase)) / (1 + f * f - 2 * f * std::cos(phase)), 1e-12);
  }
}

TEST(Optics, ColorsOfFilmsAreHeldByTheBasis) {
  SpectralScene scene = scene_of_lights({"D65", "A"});
  scene.reflectances.clear();
  for (int nm = 0; nm <= 800; nm += 40)
    scene.reflectances.push_back({std::to_string(nm), film_spectrum({1.33, 1, 1.0 * nm}, 1)});
  scene.reflectances.erase(scene.reflectances.begin());  // no film, no light
  const auto direct = reflection_chains(scene.reflectances.size(), 1);
  EXPECT_LT(basis_errors(scene, BasisFinder(scene).characteristic(6), direct).worst, 1.0);
}

TEST(Optics, FluorescenceMakesNoEnergyAndIsHeldByTheBasis) {
  FluorescentSurface paint{flat_spectrum(0.1), flat_spectrum(0), flat_spectrum(0), 0.9};
  for (int i = 0; i < wavelength_count; ++i) {
    paint.absorption(i) = 0.85 * std::exp(-std::pow((wavelength_nm(i) - 450) / 40, 2));
    paint.emission(i) = std::exp(-std::pow((wavelength_nm(i) - 530) / 20, 2));
    paint.reflectance(i) = 0.1 + 0.5 / (1 + std::exp((560 - wavelength_nm(i)) / 15));
  }
  const SpectrumMatrix matrix = reradiation_matrix(paint);
  for (int in = 0; in < wavelength_count; ++in) {
    EXPECT_LE(matrix.col(in).sum(), 1) << wavelength_nm(in);
    double photons = 0;
    for (int out = 0; out < wavelength_count; ++out) {
      if (out < in) {
        EXPECT_EQ(matrix(out, in), 0);
      }
      if (out > in) photons += matrix(out, in) * wavelength_nm(out) / wavelength_nm(in);
    }
    EXPECT_LE(photons, paint.yield * paint.absorption(in) + 1e-12);
    if (wavelength_nm(in) < 420) {
      EXPECT_NEAR(photons, paint.yield * paint.absorption(in), 1e-4);  // all of it is emitted above
    }
  }
  // Under blue light it sends out green, which no reflectance does; the basis says the same as the truth.
  SpectralScene scene = scene_of_lights({"D65", "F11"});
  NamedSpectrum blue{"blue", flat_spectrum(0)};
  for (int i = 0; i < wavelength_count; ++i) blue.values(i) = std::exp(-std::pow((wavelength_nm(i) - 450) / 10, 2));
  scene.lights.push_back(blue);
  for (const NamedSpectrum& light : std::vector(scene.lights)) {
    const Spectrum sent = (matrix * light.values.matrix()).array();
    scene.lights.push_back({"from " + light.name, sent});
  }
  const SpectralBasis basis = BasisFinder(scene).characteristic(8);
  const Eigen::MatrixXd reader = sensor_matrix(basis, scene.observer), surface = surface_matrix(basis, matrix);
  for (int l = 0; l < 3; ++l) {
    const NamedSpectrum& light = scene.lights[static_cast<std::size_t>(l)];
    const Xyz truth = scene.observer.transpose() * (matrix * light.values.matrix());
    const Xyz computed = reader * surface * light_vector(basis, light.values, scene.observer);
    const Xyz white = xyz_of(scene.lights[0].values, scene.observer) * (truth.y() > 1 ? truth.y() : 1);
    EXPECT_LT(ciede2000(lab_of(truth, white), lab_of(computed, white)), 0.5) << light.name;
    if (light.name == "blue") {
      EXPECT_GT(truth.y(),
                2 * xyz_of(light.values, scene.observer).y());  // brighter than white paper, as such paints are
    }
  }
}

}  // namespace test_spectral_basis
}  // namespace kiln
