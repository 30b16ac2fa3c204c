// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/spectral_error.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "spectrum/colorimetry.h"

namespace kiln {

namespace {

/// Returns the share of light that a chain of surfaces reflects.
Spectrum product_of(const std::vector<Spectrum>& reflectances, const ReflectionChain& chain) {
  Spectrum product = flat_spectrum(1);
  for (const std::size_t surface : chain) product *= reflectances[surface];
  return product;
}

std::vector<Spectrum> values_of(const std::vector<NamedSpectrum>& named) {
  std::vector<Spectrum> values;
  for (const NamedSpectrum& spectrum : named) values.push_back(spectrum.values);
  return values;
}

/// Returns `count` chains: each surface again and again, as far as half of them go, then points of an additive
/// recurrence, whose steps are powers of the root of x^(d + 1) = x + 1.
std::vector<ReflectionChain> spread_chains(std::size_t surfaces, int reflections, std::size_t count) {
  std::vector<ReflectionChain> chains;
  for (std::size_t s = 0; s < std::min(surfaces, count / 2); ++s)
    chains.emplace_back(static_cast<std::size_t>(reflections), s);
  double root = 1.5;
  for (int round = 0; round < 60; ++round) root = std::pow(1 + root, 1.0 / (reflections + 1));
  for (double number = 1; chains.size() < count; ++number) {
    ReflectionChain chain;
    for (int k = 1; k <= reflections; ++k) {
      const double place = number / std::pow(root, k);
      chain.push_back(std::min(surfaces - 1,
                               static_cast<std::size_t>((place - std::floor(place)) * static_cast<double>(surfaces))));
    }
    std::sort(chain.begin(), chain.end());
    chains.push_back(std::move(chain));
  }
  return chains;
}

}  // namespace

ColorErrors color_errors(const SpectralScene& scene, const std::vector<ReflectionChain>& chains,
                         FunctionRef<Xyz(std::size_t light, const ReflectionChain& chain)> computed) {
  const std::vector<Spectrum> reflectances = values_of(scene.reflectances);
  std::vector<SpectrumMatrix> readings;
  for (const NamedSpectrum& light : scene.lights)
    readings.push_back(light.values.matrix().asDiagonal() * scene.observer);
  ColorErrors errors;
  for (const ReflectionChain& chain : chains) {
    const Spectrum reflected = product_of(reflectances, chain);
    for (std::size_t l = 0; l < scene.lights.size(); ++l) {
      const Xyz white = readings[l].colwise().sum();
      const Xyz truth = readings[l].transpose() * reflected.matrix();
      const double error = ciede2000(lab_of(truth, white), lab_of(computed(l, chain), white));
      errors.mean += error;
      if (error <= errors.worst && !errors.worst_at.empty()) continue;
      errors.worst = error;
      errors.worst_at = scene.lights[l].name + ",";
      for (const std::size_t surface : chain) errors.worst_at += " " + scene.reflectances[surface].name;
    }
  }
  errors.mean /= static_cast<double>(chains.size() * scene.lights.size());
  return errors;
}

std::vector<ReflectionChain> reflection_chains(std::size_t surfaces, int reflections, std::size_t most) {
  // Count them first: n + k - 1 over k.
  double count = 1;
  for (int k = 1; k <= reflections; ++k) count *= (static_cast<double>(surfaces) + k - 1) / k;
  if (count > static_cast<double>(most)) return spread_chains(surfaces, reflections, most);
  std::vector<ReflectionChain> chains;
  ReflectionChain chain(static_cast<std::size_t>(reflections), 0);
  for (;;) {
    chains.push_back(chain);
    auto last = chain.rbegin();
    while (last != chain.rend() && *last + 1 == surfaces) ++last;
    if (last == chain.rend()) return chains;
    const std::size_t raised = *last + 1;
    std::fill(last.base() - 1, chain.end(), raised);
  }
}

ColorErrors basis_errors(const SpectralScene& scene, const SpectralBasis& basis,
                         const std::vector<ReflectionChain>& chains) {
  std::vector<Eigen::VectorXd> lights;
  for (const NamedSpectrum& light : scene.lights) lights.push_back(light_vector(basis, light.values, scene.observer));
  std::vector<Eigen::MatrixXd> surfaces;
  for (const NamedSpectrum& reflectance : scene.reflectances)
    surfaces.push_back(surface_matrix(basis, reflectance.values));
  const Eigen::MatrixXd reader = sensor_matrix(basis, scene.observer);
  return color_errors(scene, chains, [&](std::size_t l, const ReflectionChain& chain) -> Xyz {
    Eigen::VectorXd light = lights[l];
    for (const std::size_t surface : chain) light = surfaces[surface] * light;
    return reader * light;
  });
}

ColorErrors rgb_errors(const SpectralScene& scene, const RgbLift& lift, const std::vector<ReflectionChain>& chains) {
  const Eigen::Matrix3d& to_rgb = lift.rgb_from_xyz();
  const Eigen::Matrix3d to_xyz = to_rgb.inverse();
  std::vector<Eigen::Vector3d> albedos;
  for (const NamedSpectrum& reflectance : scene.reflectances)
    albedos.push_back(lift.albedo_of(reflectance.values).cwiseMax(0).cwiseMin(1));
  return color_errors(scene, chains, [&](std::size_t l, const ReflectionChain& chain) -> Xyz {
    Eigen::Vector3d light = to_rgb * xyz_of(scene.lights[l].values, scene.observer);
    for (const std::size_t surface : chain) light = light.cwiseProduct(albedos[surface]);
    return to_xyz * light;
  });
}

ColorErrors lifted_errors(const SpectralScene& scene, const RgbLift& lift, const std::vector<ReflectionChain>& chains) {
  std::vector<Spectrum> lifted;
  for (const NamedSpectrum& reflectance : scene.reflectances)
    lifted.push_back(lift.lift(lift.albedo_of(reflectance.values)).spectrum());
  return color_errors(scene, chains, [&](std::size_t l, const ReflectionChain& chain) {
    return xyz_of(scene.lights[l].values * product_of(lifted, chain), scene.observer);
  });
}

}  // namespace kiln
