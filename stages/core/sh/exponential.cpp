// SPDX-License-Identifier: MIT
#include "sh/exponential.h"

#include <Eigen/Core>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <memory>
#include <mutex>
#include <numbers>

#include "sh/basis.h"
#include "sh/product.h"
#include "sh/quadrature.h"

namespace kiln {

namespace {

constexpr int most_bands = 10, angle_steps = 128, norm_steps = 64;
constexpr double pi = std::numbers::pi, largest_norm = 0.5;

/// Evaluates Y_l0 at a height z, for all bands.
std::vector<double> zonal_basis(int bands, double z) {
  std::vector<double> values(static_cast<std::size_t>(bands));
  double before = 0, p = 1;
  for (int l = 0; l < bands; ++l) {
    values[static_cast<std::size_t>(l)] = std::sqrt((2 * l + 1) / (4 * pi)) * p;
    const double after = ((2 * l + 1) * z * p - l * before) / (l + 1);
    before = p;
    p = after;
  }
  return values;
}

/// Computes coefficients of Y_l0 of the logarithm of the visibility past a ball.
Eigen::VectorXd zonal_logarithm(int bands, double half_angle) {
  constexpr double smallest = 0.02;
  // The operator's part of order 0, which alone acts on 1: integrals of two zonal functions over what is not hidden.
  Eigen::MatrixXd products = Eigen::MatrixXd::Zero(bands, bands);
  const double top = std::cos(half_angle);
  for (const LineNode& node : gauss_legendre(bands)) {
    const std::vector<double> values = zonal_basis(bands, 0.5 * (top + 1) * (node.place + 1) - 1);
    const Eigen::Map<const Eigen::VectorXd> there(values.data(), bands);
    products += 2 * pi * 0.5 * (top + 1) * node.weight * there * there.transpose();
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(products);
  const Eigen::VectorXd logs = solver.eigenvalues().array().max(smallest).min(1.0).log();
  return std::sqrt(4 * pi) * solver.eigenvectors() * logs.asDiagonal() * solver.eigenvectors().transpose().col(0);
}

}  // namespace

ShExponential::ShExponential(int bands) : bands_(bands) {
  assert(bands >= 1 && bands <= most_bands);
  std::vector<Eigen::VectorXd> zonal;
  for (int step = 0; step <= angle_steps; ++step) {
    zonal.push_back(zonal_logarithm(bands, 0.5 * pi * step / angle_steps));
    std::vector<double>& factors = logarithms_.emplace_back();
    for (int l = 0; l < bands; ++l) factors.push_back(zonal.back()[l] * std::sqrt(4 * pi / (2 * l + 1)));
  }

  // Fits a + b f to exp(f) over the logarithms of balls, without band 0 and scaled to a norm.
  const std::vector<LineNode> nodes = gauss_legendre(6 * bands + 16);
  std::vector<std::vector<double>> rows;
  for (const LineNode& node : nodes) rows.push_back(zonal_basis(bands, node.place));
  for (int step = 0; step <= norm_steps; ++step) {
    const double norm = largest_norm * step / norm_steps;
    if (step == 0 || bands == 1) {
      linear_.push_back({1, 1});
      continue;
    }
    // a is band 0 of the exponential, averaged; b the projection of the others onto f.
    double constants = 0, slopes = 0;
    int count = 0;
    for (int k = angle_steps / 16; k <= angle_steps; k += angle_steps / 16) {
      Eigen::VectorXd f = zonal[static_cast<std::size_t>(k)];
      f[0] = 0;
      f *= norm / f.norm();
      Eigen::VectorXd exact = Eigen::VectorXd::Zero(bands);
      for (std::size_t s = 0; s < nodes.size(); ++s) {
        const Eigen::Map<const Eigen::VectorXd> there(rows[s].data(), bands);
        exact += 2 * pi * nodes[s].weight * std::exp(f.dot(there)) * there;
      }
      constants += exact[0] / std::sqrt(4 * pi);
      slopes += exact.dot(f) / f.squaredNorm();
      ++count;
    }
    linear_.push_back({constants / count, slopes / count});
  }
}

const ShExponential& ShExponential::of_bands(int bands) {
  assert(bands >= 1 && bands <= most_bands);
  static std::array<std::once_flag, most_bands + 1> once;
  static std::array<std::unique_ptr<const ShExponential>, most_bands + 1> all;
  const auto slot = static_cast<std::size_t>(bands);
  std::call_once(once[slot], [&] { all[slot] = std::make_unique<const ShExponential>(bands); });
  return *all[slot];
}

std::vector<float> ShExponential::operator()(std::span<const float> f) const {
  assert(static_cast<int>(f.size()) == coefficient_count(bands_));
  const double unit = std::sqrt(4 * pi);
  double square = 0;
  for (std::size_t i = 1; i < f.size(); ++i) square += static_cast<double>(f[i]) * static_cast<double>(f[i]);
  double norm = std::sqrt(square), factor = 1;
  int halvings = 0;
  for (; norm > largest_norm; ++halvings) {
    norm /= 2;
    factor /= 2;
  }
  const double place = norm / largest_norm * norm_steps;
  const auto step = static_cast<std::size_t>(std::min(place, norm_steps - 1.0));
  const double t = place - static_cast<double>(step);
  const double constant = (1 - t) * linear_[step].constant + t * linear_[step + 1].constant,
               slope = (1 - t) * linear_[step].slope + t * linear_[step + 1].slope;
  std::vector<float> result(f.size());
  result[0] = static_cast<float>(constant * unit);
  for (std::size_t i = 1; i < f.size(); ++i) result[i] = static_cast<float>(slope * factor * static_cast<double>(f[i]));
  const ShProduct& product = ShProduct::of_bands(bands_);
  for (int k = 0; k < halvings; ++k) result = product(result, result);
  const double mean = std::exp(static_cast<double>(f[0]) / unit);
  for (float& value : result) value = static_cast<float>(mean * static_cast<double>(value));
  return result;
}

std::vector<double> ShExponential::ball_logarithm(double half_angle) const {
  const double place = std::clamp(half_angle / (0.5 * pi), 0.0, 1.0) * angle_steps;
  const auto step = static_cast<std::size_t>(std::min(place, angle_steps - 1.0));
  // Squares of angles are interpolated, since what thin balls cover goes with these.
  const auto from = static_cast<double>(step);
  const double t = (place * place - from * from) / (2 * from + 1);
  std::vector<double> zonal(logarithms_[step]);
  for (std::size_t l = 0; l < zonal.size(); ++l) zonal[l] = (1 - t) * zonal[l] + t * logarithms_[step + 1][l];
  return zonal;
}

}  // namespace kiln
