// SPDX-License-Identifier: GPL-3.0-or-later
#include "spectrum/wavelengths.h"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "spectrum/colorimetry.h"

namespace kiln {

namespace {

constexpr int first_nm = 400, step_nm = 5, candidates = 61;
constexpr std::size_t most_samples = 500;
constexpr int most_rounds = 50;

/// Sums of least squares for one lamp: of products of what the candidates reflect, and of these with X, Y and Z.
struct LampSums {
  SpectrumMatrix among = SpectrumMatrix::Zero(candidates, candidates);
  SpectrumMatrix with_color = SpectrumMatrix::Zero(candidates, 3);
  Eigen::Matrix3d color = Eigen::Matrix3d::Zero();
};

/// Adds a surface's reflectance at the candidates, its colour as shares of white, and a weight.
void add(LampSums& sums, const Eigen::VectorXd& at, const Eigen::Vector3d& share, double weight) {
  for (Eigen::Index j = 0; j < candidates; ++j) sums.among.col(j) += weight * at(j) * at;
  for (int c = 0; c < 3; ++c) sums.with_color.col(c) += weight * share(c) * at;
  sums.color += weight * share * share.transpose();
}

/// Returns a matrix of 3 rows whose rows add up to 1: the best shares of X, Y and Z from what some candidates reflect.
Eigen::MatrixXd best_reader(const LampSums& sums, const std::vector<int>& chosen) {
  const auto size = static_cast<Eigen::Index>(chosen.size());
  Eigen::MatrixXd among(size, size), with_color(size, 4);
  for (Eigen::Index i = 0; i < size; ++i) {
    const int row = chosen[static_cast<std::size_t>(i)];
    for (Eigen::Index j = 0; j < size; ++j) among(i, j) = sums.among(row, chosen[static_cast<std::size_t>(j)]);
    for (int c = 0; c < 3; ++c) with_color(i, c) = sums.with_color(row, c);
    with_color(i, 3) = 1;
  }
  among.diagonal() *= 1 + 1e-12;
  const Eigen::LDLT<Eigen::MatrixXd> solver(among);
  const Eigen::MatrixXd solved = solver.solve(with_color);
  Eigen::MatrixXd reader(3, size);
  for (int c = 0; c < 3; ++c) {
    const double excess = (solved.col(c).sum() - 1) / solved.col(3).sum();
    reader.row(c) = (solved.col(c) - excess * solved.col(3)).transpose();
  }
  return reader;
}

/// Returns the weighted sum of squares that the best reader leaves.
double cost_of(const std::vector<LampSums>& lamps, const std::vector<int>& chosen) {
  double cost = 0;
  for (const LampSums& sums : lamps) {
    const Eigen::MatrixXd reader = best_reader(sums, chosen);
    Eigen::Matrix3d left = sums.color;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b)
        for (std::size_t i = 0; i < chosen.size(); ++i) {
          const auto row = static_cast<Eigen::Index>(i);
          left(a, b) -= reader(a, row) * sums.with_color(chosen[i], b) + reader(b, row) * sums.with_color(chosen[i], a);
          for (std::size_t j = 0; j < chosen.size(); ++j)
            left(a, b) += reader(a, row) * sums.among(chosen[i], chosen[j]) * reader(b, static_cast<Eigen::Index>(j));
        }
    // Slopes of L*, a* and b*, without their common factor.
    const double x = left(0, 0), y = left(1, 1), z = left(2, 2);
    cost += 116 * 116 * y + 500 * 500 * (x + y - 2 * left(0, 1)) + 200 * 200 * (y + z - 2 * left(1, 2));
  }
  return cost;
}

/// Puts the best candidate in place of entry `k`; returns the cost.
double improve(const std::vector<LampSums>& lamps, std::vector<int>& chosen, std::size_t k) {
  double least = std::numeric_limits<double>::infinity();
  int best = chosen[k];
  for (int candidate = 0; candidate < candidates; ++candidate) {
    if (std::count(chosen.begin(), chosen.end(), candidate) > (chosen[k] == candidate ? 1 : 0)) continue;
    std::vector<int> tried = chosen;
    tried[k] = candidate;
    const double cost = cost_of(lamps, tried);
    if (cost < least) {
      least = cost;
      best = candidate;
    }
  }
  chosen[k] = best;
  return least;
}

}  // namespace

WavelengthSet find_wavelengths(const SpectralScene& scene, int size) {
  // Sum over what comes back after one to three reflections.
  std::vector<LampSums> lamps(scene.lights.size());
  for (int reflections = 1; reflections <= 3; ++reflections)
    for (const ReflectionChain& chain : reflection_chains(scene.reflectances.size(), reflections, most_samples)) {
      Spectrum product = flat_spectrum(1);
      for (const std::size_t surface : chain) product *= scene.reflectances[surface].values;
      Eigen::VectorXd at(candidates);
      for (int k = 0; k < candidates; ++k) at(k) = product(first_nm + k * step_nm - first_wavelength_nm);
      for (std::size_t l = 0; l < lamps.size(); ++l) {
        const Spectrum& light = scene.lights[l].values;
        const Eigen::Vector3d share =
            xyz_of(light * product, scene.observer).cwiseQuotient(xyz_of(light, scene.observer));
        // L*'s slope falls as Y^(-2/3), down to where it is straight.
        add(lamps[l], at, share, std::pow(std::max(share.y(), 0.008856), -4.0 / 3));
      }
    }

  // Choose one after another, and exchange each until none improves by a thousandth, or what is left is rounding.
  double rounding = 0;
  for (const LampSums& sums : lamps) rounding += 1e-9 * 500 * 500 * sums.color.trace();
  std::vector<int> chosen;
  for (int count = 0; count < size; ++count) {
    int unused = 0;
    while (std::count(chosen.begin(), chosen.end(), unused) > 0) ++unused;
    chosen.push_back(unused);
    double cost = improve(lamps, chosen, chosen.size() - 1);
    bool is_better = true;
    for (int round = 0; round < most_rounds && is_better && cost > rounding; ++round) {
      const double before = cost;
      for (std::size_t k = 0; k < chosen.size(); ++k) cost = improve(lamps, chosen, k);
      is_better = cost < 0.999 * before;
    }
  }
  std::sort(chosen.begin(), chosen.end());

  WavelengthSet set;
  for (const int candidate : chosen) set.wavelengths_nm.push_back(first_nm + candidate * step_nm);
  for (std::size_t l = 0; l < lamps.size(); ++l) {
    Eigen::MatrixXd reader = best_reader(lamps[l], chosen);
    const Xyz white = xyz_of(scene.lights[l].values, scene.observer);
    for (int c = 0; c < 3; ++c) reader.row(c) *= white(c);
    set.readers.push_back(std::move(reader));
  }
  return set;
}

ColorErrors wavelength_errors(const SpectralScene& scene, const WavelengthSet& set,
                              const std::vector<ReflectionChain>& chains) {
  return color_errors(scene, chains, [&](std::size_t l, const ReflectionChain& chain) -> Xyz {
    Xyz color = Xyz::Zero();
    for (std::size_t k = 0; k < set.wavelengths_nm.size(); ++k) {
      double back = 1;
      for (const std::size_t surface : chain)
        back *= scene.reflectances[surface].values(set.wavelengths_nm[k] - first_wavelength_nm);
      for (int c = 0; c < 3; ++c) color(c) += set.readers[l](c, static_cast<Eigen::Index>(k)) * back;
    }
    return color;
  });
}

}  // namespace kiln
