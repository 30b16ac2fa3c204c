// SPDX-License-Identifier: MIT
#include "sh/basis.h"

#include <cassert>
#include <cmath>
#include <numbers>

namespace kiln {

int band_of(int index) {
  int band = static_cast<int>(std::sqrt(static_cast<double>(index)));
  while (band * band > index) --band;
  while ((band + 1) * (band + 1) <= index) ++band;
  return band;
}

ShBasis::ShBasis(int bands) : bands_(bands), first_(size()), second_(size()), sectoral_(bands) {
  assert(bands >= 1 && bands <= 65);
  // The square root of two of the real harmonics with m != 0 sits in the first sectoral step.
  sectoral_[0] = std::sqrt(1 / (4 * std::numbers::pi));
  for (int m = 1; m < bands; ++m)
    sectoral_[m] = sectoral_[m - 1] * std::sqrt((m == 1 ? 2.0 : 1.0) * (2 * m + 1) / (2.0 * m));
  for (int m = 0; m < bands; ++m)
    for (int l = m + 1; l < bands; ++l) {
      const double a = std::sqrt((4.0 * l * l - 1) / (static_cast<double>(l) * l - m * m));
      const double k = l - 1;
      const double b = l == m + 1 ? 0 : std::sqrt((k * k - m * m) / (4 * k * k - 1));
      first_[coefficient_index(l, m)] = a;
      second_[coefficient_index(l, m)] = a * b;
    }
}

template <class Real>
void ShBasis::evaluate(const Eigen::Matrix<Real, 3, 1>& direction, std::span<Real> values) const {
  assert(static_cast<int>(values.size()) == size());
  const Real x = direction.x(), y = direction.y(), z = direction.z();
  Real cosine = 1, sine = 0;  // sin^m(theta) cos(m phi), sin^m(theta) sin(m phi)
  for (int m = 0; m < bands_; ++m) {
    Real before = 0, p = static_cast<Real>(sectoral_[m]);
    for (int l = m; l < bands_; ++l) {
      if (l > m) {
        const int index = coefficient_index(l, m);
        const Real next = static_cast<Real>(first_[index]) * z * p - static_cast<Real>(second_[index]) * before;
        before = p;
        p = next;
      }
      values[coefficient_index(l, m)] = p * cosine;
      if (m > 0) values[coefficient_index(l, -m)] = p * sine;
    }
    const Real rotated = x * cosine - y * sine;
    sine = x * sine + y * cosine;
    cosine = rotated;
  }
}

template void ShBasis::evaluate<float>(const Eigen::Vector3f&, std::span<float>) const;
template void ShBasis::evaluate<double>(const Eigen::Vector3d&, std::span<double>) const;

std::vector<double> clamped_cosine_bands(int bands) {
  std::vector<double> factors(bands, 0.0);
  for (int l = 0; l < bands; ++l) {
    if (l == 0)
      factors[l] = std::numbers::pi;
    else if (l == 1)
      factors[l] = 2 * std::numbers::pi / 3;
    else if (l % 2 == 0) {
      // 2 pi (-1)^(l/2-1) / ((l+2)(l-1)) * l! / (2^l ((l/2)!)^2); the last factor as a product, which cannot overflow.
      double central = 1;
      for (int k = 1; k <= l / 2; ++k) central *= (2.0 * k - 1) / (2.0 * k);
      factors[l] = 2 * std::numbers::pi * ((l / 2) % 2 == 1 ? 1 : -1) / ((l + 2.0) * (l - 1.0)) * central;
    }
  }
  return factors;
}

std::vector<float> unoccluded_transfer(const ShBasis& basis, const Eigen::Vector3f& normal) {
  const std::vector<double> factors = clamped_cosine_bands(basis.bands());
  std::vector<double> values(basis.size());
  basis.evaluate<double>(normal.cast<double>().normalized(), values);
  std::vector<float> transfer(basis.size());
  for (int i = 0; i < basis.size(); ++i)
    transfer[i] = static_cast<float>(factors[band_of(i)] / std::numbers::pi * values[i]);
  return transfer;
}

}  // namespace kiln
