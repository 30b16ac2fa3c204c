// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Index of the coefficient of band l, order m: l(l+1)+m.
constexpr int coefficient_index(int l, int m) { return l * (l + 1) + m; }

/// Coefficients of `bands` bands: bands^2.
constexpr int coefficient_count(int bands) { return bands * bands; }

/// Returns the band that coefficient `index` belongs to.
int band_of(int index);

/// Real, orthonormal spherical harmonics without the Condon-Shortley phase (Y_1^-1 = +0.488603 y), for l < bands.
class ShBasis {
 public:
  /// `bands` of 1 to 65.
  explicit ShBasis(int bands);

  int bands() const { return bands_; }
  int size() const { return coefficient_count(bands_); }

  /// Evaluates all basis functions at a unit vector; `values` has size() entries. Uses the fully normalised recurrences
  /// of [Holmes 2002], equations 11 and 12, with sin^m and the azimuth taken together as powers of x + iy [Sloan 2013],
  /// so nothing overflows and no pole is singular.
  template <class Real>
  void evaluate(const Eigen::Matrix<Real, 3, 1>& direction, std::span<Real> values) const;

 private:
  int bands_;
  std::vector<double> first_;   // factor of z p(l-1,m), by coefficient_index(l, m)
  std::vector<double> second_;  // factor of p(l-2,m)
  std::vector<double> sectoral_;
};

/// Returns the zonal coefficients A_l of the clamped cosine: the integral of Y_lm(s) max(0, n.s) ds is A_l Y_lm(n)
/// ([Ramamoorthi 2001], equation 8).
std::vector<double> clamped_cosine_bands(int bands);

/// Returns the transfer of a texel that nothing occludes: A_l / pi Y_lm(n).
std::vector<float> unoccluded_transfer(const ShBasis& basis, const Eigen::Vector3f& normal);

}  // namespace kiln
