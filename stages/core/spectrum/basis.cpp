// SPDX-License-Identifier: GPL-3.0-or-later
// Bases of generalised linear colour: [Peercy 1995], the paper's section "Generalized Linear Color Representations";
// balanced truncation after [Moore 1981].

#include "spectrum/basis.h"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <algorithm>
#include <cassert>
#include <optional>

#include "spectrum/colorimetry.h"

namespace kiln {

namespace {

/// Weight of a reflection's moment beside that of light itself. Six functions for the lamps A, D50, D65, F2, F7 and F11
/// and the CIE's test samples leave a worst CIEDE2000 of 0.2 in direct light and 13 at three reflections with a weight
/// of 1, 0.7 and 3.8 with 10, 0.7 and 3.5 with 100.
constexpr double reflection_weight = 10;

/// Returns a b and a' b. Products of expressions are avoided in this file: each form of them takes a second to compile.
SpectrumMatrix product(const SpectrumMatrix& a, const SpectrumMatrix& b) { return a * b; }
SpectrumMatrix dot_products(const SpectrumMatrix& a, const SpectrumMatrix& b) { return a.transpose() * b; }

/// Adds v v' to a matrix.
void add_square(SpectrumMatrix& sum, const Eigen::VectorXd& v) {
  for (Eigen::Index j = 0; j < v.size(); ++j) sum.col(j) += v(j) * v;
}

/// Returns 1 + G + G^2, entry by entry, for G the mean of r r' over the reflectances times the weight.
SpectrumMatrix chains_of_reflections(const std::vector<NamedSpectrum>& reflectances) {
  SpectrumMatrix moment = SpectrumMatrix::Zero(wavelength_count, wavelength_count);
  for (const NamedSpectrum& reflectance : reflectances) add_square(moment, reflectance.values.matrix());
  moment *= reflection_weight / static_cast<double>(reflectances.size());
  return (1 + moment.array() + moment.array().square()).matrix();
}

/// Returns the slopes of L*, a* and b* at a white, per share of the white's X, Y and Z.
Eigen::Matrix3d lab_slopes() {
  Eigen::Matrix3d slopes;
  slopes << 0, 116, 0, 500, -500, 0, 0, 200, -200;
  return slopes / 3;
}

/// Returns the inverse of C' C for C of three columns; nothing where they depend on each other.
std::optional<Eigen::Matrix3d> inverse_square(const SpectrumMatrix& colors) {
  const Eigen::Matrix3d square = dot_products(colors, colors);
  const Eigen::Vector3d scale = square.diagonal().cwiseSqrt().cwiseInverse();
  const Eigen::Matrix3d scaled = scale.asDiagonal() * square * scale.asDiagonal();
  if (!(scaled.determinant() > 1e-10)) return std::nullopt;
  return scale.asDiagonal() * scaled.inverse() * scale.asDiagonal();
}

}  // namespace

BasisFinder::BasisFinder(const SpectralScene& scene) : scene_(scene) {
  assert(!scene.lights.empty() && !scene.reflectances.empty());
  const SpectrumMatrix chains = chains_of_reflections(scene.reflectances);

  // Moments of light, and of what is seen of it.
  SpectrumMatrix light = SpectrumMatrix::Zero(wavelength_count, wavelength_count), seen = light;
  for (const NamedSpectrum& lamp : scene.lights) {
    const Xyz white = xyz_of(lamp.values, scene.observer);
    add_square(light, lamp.values.matrix() / white.y());
    const SpectrumMatrix slopes =
        product(scene.observer, (lab_slopes() * white.cwiseInverse().asDiagonal()).transpose());
    for (int k = 0; k < 3; ++k) add_square(seen, slopes.col(k));
  }
  light = light.cwiseProduct(chains);
  seen = seen.cwiseProduct(chains);

  // A root of the second, without directions that are rounding.
  constexpr double rounding = 1e-13;
  const Eigen::SelfAdjointEigenSolver<SpectrumMatrix> seen_parts(seen);
  const Eigen::VectorXd& strengths = seen_parts.eigenvalues();
  const auto kept = (strengths.array() > rounding * strengths(wavelength_count - 1)).count();
  seen_ = seen_parts.eigenvectors().rightCols(kept) * strengths.tail(kept).cwiseSqrt().asDiagonal();

  // Directions of light that is strong where it is seen.
  const Eigen::SelfAdjointEigenSolver<SpectrumMatrix> parts(dot_products(seen_, product(light, seen_)));
  rank_ = static_cast<int>((parts.eigenvalues().array() > rounding * parts.eigenvalues()(kept - 1)).count());
  directions_ = product(light, product(seen_, parts.eigenvectors().rightCols(rank_).rowwise().reverse()));
}

SpectralBasis BasisFinder::characteristic(int size) const {
  assert(size >= 1 && size <= rank_);
  return with_duals("characteristic", directions_.leftCols(size));
}

SpectralBasis BasisFinder::lights() const {
  // Take each lamp that has something, in what is seen, that those before it have not.
  SpectrumMatrix lamps(wavelength_count, static_cast<Eigen::Index>(scene_.lights.size()));
  SpectrumMatrix seen_so_far(seen_.cols(), lamps.cols());
  Eigen::Index count = 0;
  for (const NamedSpectrum& light : scene_.lights) {
    Eigen::VectorXd seen = dot_products(seen_, light.values.matrix());
    const double strength = seen.norm();
    for (int round = 0; round < 2; ++round)
      for (Eigen::Index j = 0; j < count; ++j) seen -= seen.dot(seen_so_far.col(j)) * seen_so_far.col(j);
    if (seen.norm() <= 1e-6 * strength) continue;
    lamps.col(count) = light.values.matrix();
    seen_so_far.col(count++) = seen.normalized();
  }
  return with_duals("lights", lamps.leftCols(count));
}

SpectralBasis BasisFinder::points(int size) const {
  assert(size >= 2);
  SpectralBasis basis{"points", SpectrumMatrix::Zero(wavelength_count, size),
                      SpectrumMatrix::Zero(wavelength_count, size)};
  const double step = 300.0 / (size - 1);
  for (int i = 0; i < wavelength_count; ++i) {
    const double place = std::clamp((wavelength_nm(i) - 400) / step, 0.0, size - 1.0);
    const int below = std::min(static_cast<int>(place), size - 2);
    basis.functions(i, below) = 1 - (place - below);
    basis.functions(i, below + 1) = place - below;
  }
  for (int j = 0; j < size; ++j) {
    const double place = 400 + j * step - first_wavelength_nm;
    const int below = std::min(static_cast<int>(place), wavelength_count - 2);
    basis.duals(below, j) = 1 - (place - below);
    basis.duals(below + 1, j) = place - below;
  }
  return basis;
}

SpectralBasis BasisFinder::with_duals(std::string kind, SpectrumMatrix functions) const {
  for (Eigen::Index j = 0; j < functions.cols(); ++j) functions.col(j) /= functions.col(j).cwiseAbs().maxCoeff();

  // Functions that are orthonormal in what is seen, by Gram and Schmidt: weights that come closest are dot products
  // then.
  SpectrumMatrix orthonormal = functions, seen = dot_products(seen_, functions);
  SpectrumMatrix ways = SpectrumMatrix::Identity(functions.cols(), functions.cols());  // orthonormal = functions * ways
  for (Eigen::Index j = 0; j < functions.cols(); ++j) {
    for (int round = 0; round < 2; ++round)
      for (Eigen::Index i = 0; i < j; ++i) {
        const double share = seen.col(i).dot(seen.col(j));
        for (SpectrumMatrix* const columns : {&orthonormal, &seen, &ways}) columns->col(j) -= share * columns->col(i);
      }
    const double length = seen.col(j).norm();
    for (SpectrumMatrix* const columns : {&orthonormal, &seen, &ways}) columns->col(j) /= length;
  }
  SpectrumMatrix duals = product(seen_, seen);

  // Move the weights, as little as it takes, to where X, Y and Z are kept.
  const SpectrumMatrix colors = dot_products(orthonormal, scene_.observer);
  if (const std::optional<Eigen::Matrix3d> square = inverse_square(colors))
    duals += product(product(scene_.observer - product(duals, colors), *square), colors.transpose());
  return {std::move(kind), std::move(functions), product(duals, ways.transpose())};
}

Eigen::VectorXd light_vector(const SpectralBasis& basis, const Spectrum& light, const SpectrumMatrix& observer) {
  Eigen::VectorXd weights = dot_products(basis.duals, light.matrix());
  const SpectrumMatrix colors = dot_products(basis.functions, observer);
  const Xyz missing = xyz_of(light, observer) - dot_products(colors, weights);
  if (const std::optional<Eigen::Matrix3d> square = inverse_square(colors))
    weights += product(colors, *square * missing);
  return weights;
}

Eigen::MatrixXd surface_matrix(const SpectralBasis& basis, const Spectrum& reflectance) {
  return dot_products(basis.duals, reflectance.matrix().asDiagonal() * basis.functions);
}

Eigen::MatrixXd surface_matrix(const SpectralBasis& basis, const SpectrumMatrix& reradiation) {
  return dot_products(basis.duals, product(reradiation, basis.functions));
}

Eigen::MatrixXd sensor_matrix(const SpectralBasis& basis, const SpectrumMatrix& responses) {
  return dot_products(responses, basis.functions);
}

}  // namespace kiln
