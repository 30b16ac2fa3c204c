// SPDX-License-Identifier: MIT
#include "sh/rotation.h"

#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <stdexcept>

#include "sh/basis.h"

namespace kiln {

namespace {

/// Matrix of one band from that of the band before it; names and signs are those of [Ivanic 1996], tables 1 and 2.
class Recursion {
 public:
  Recursion(const Eigen::MatrixXd& first, const Eigen::MatrixXd& before, int l)
      : first_(first), before_(before), l_(l) {}

  double element(int m, int n) const {
    const double denominator = std::abs(n) == l_ ? 2.0 * l_ * (2.0 * l_ - 1) : static_cast<double>((l_ + n) * (l_ - n));
    const int order = std::abs(m);
    const double u = std::sqrt((l_ + m) * (l_ - m) / denominator);
    const double v = 0.5 * std::sqrt((m == 0 ? 2 : 1) * (l_ + order - 1.0) * (l_ + order) / denominator);
    const double w = m == 0 ? 0 : 0.5 * std::sqrt((l_ - order - 1.0) * (l_ - order) / denominator);
    // Factors of zero stand before terms that would read outside the matrix.
    return (u != 0 ? u * p(0, m, n) : 0) + (m == 0 ? -v : v) * v_term(m, n) - (w != 0 ? w * w_term(m, n) : 0);
  }

 private:
  /// Orders -1, 0 and 1 are y, z and x.
  double r(int i, int j) const { return first_(i + 1, j + 1); }
  double of_before(int m, int n) const { return before_(m + l_ - 1, n + l_ - 1); }

  double p(int i, int m, int n) const {
    if (n == l_) return r(i, 1) * of_before(m, l_ - 1) - r(i, -1) * of_before(m, 1 - l_);
    if (n == -l_) return r(i, 1) * of_before(m, 1 - l_) + r(i, -1) * of_before(m, l_ - 1);
    return r(i, 0) * of_before(m, n);
  }
  double v_term(int m, int n) const {
    if (m == 0) return p(1, 1, n) + p(-1, -1, n);
    if (m == 1) return std::sqrt(2.0) * p(1, 0, n);
    if (m == -1) return std::sqrt(2.0) * p(-1, 0, n);
    return m > 0 ? p(1, m - 1, n) - p(-1, 1 - m, n) : p(1, m + 1, n) + p(-1, -m - 1, n);
  }
  double w_term(int m, int n) const {
    return m > 0 ? p(1, m + 1, n) + p(-1, -m - 1, n) : p(1, m - 1, n) - p(-1, 1 - m, n);
  }

  const Eigen::MatrixXd& first_;
  const Eigen::MatrixXd& before_;
  int l_;
};

}  // namespace

ShRotation::ShRotation(int bands, const Eigen::Matrix3d& rotation) {
  assert(bands >= 1 && bands <= 65);
  constexpr double tolerance = 1e-4;
  if (!(rotation * rotation.transpose()).isIdentity(tolerance) || !(rotation.determinant() > 0))
    throw std::invalid_argument("ShRotation: the matrix is no rotation");
  matrices_.emplace_back(Eigen::MatrixXd::Identity(1, 1));
  if (bands == 1) return;
  // Band 1 is the rotation itself, its axes in the order y, z, x.
  constexpr int axis[3] = {1, 2, 0};
  Eigen::MatrixXd& first = matrices_.emplace_back(3, 3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) first(i, j) = rotation(axis[i], axis[j]);
  for (int l = 2; l < bands; ++l) {
    const Recursion recursion(matrices_[1], matrices_[l - 1], l);
    Eigen::MatrixXd matrix(2 * l + 1, 2 * l + 1);
    for (int m = -l; m <= l; ++m)
      for (int n = -l; n <= l; ++n) matrix(m + l, n + l) = recursion.element(m, n);
    matrices_.push_back(std::move(matrix));
  }
}

std::vector<float> ShRotation::operator()(std::span<const float> coefficients) const {
  assert(static_cast<int>(coefficients.size()) == coefficient_count(bands()));
  std::vector<float> rotated(coefficients.size());
  for (int l = 0; l < bands(); ++l) {
    const Eigen::Map<const Eigen::VectorXf> band(coefficients.data() + l * l, 2 * l + 1);
    Eigen::Map<Eigen::VectorXf>(rotated.data() + l * l, 2 * l + 1) = (matrices_[l] * band.cast<double>()).cast<float>();
  }
  return rotated;
}

LightCoefficients ShRotation::operator()(const LightCoefficients& light) const {
  LightCoefficients rotated{light.bands, {}};
  for (const std::vector<float>& channel : light.channels) rotated.channels.push_back((*this)(channel));
  return rotated;
}

}  // namespace kiln
