// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

namespace kiln {

/// Exponentials of functions on the sphere given in spherical harmonics, and logarithms of the visibility past a ball,
/// so that products of many visibilities become sums [Ren 2006].
class ShExponential {
 public:
  /// `bands` of 1 to 10.
  explicit ShExponential(int bands);

  /// Returns the exponential of that many bands, made at its first use; safe to call from several threads.
  static const ShExponential& of_bands(int bands);

  int bands() const { return bands_; }

  /// Returns exp(f) in `bands` bands. Band 0 is taken out as a factor; the rest is halved until it is small, its
  /// exponential approximated by a + b f, with a and b the best for its norm over the logarithms of balls, and squared
  /// as often as it was halved.
  std::vector<float> operator()(std::span<const float> f) const;

  /// Returns the zonal coefficients f_l of the logarithm of a function that is 0 within `half_angle` (radians, 0 to
  /// pi/2; beyond that pi/2) of an axis and 1 elsewhere: coefficients are f_l Y_lm(axis). The logarithm is that of the
  /// operator that multiplies by the function and cuts to `bands` bands, with eigenvalues below 0.02 raised to that,
  /// applied to 1.
  std::vector<double> ball_logarithm(double half_angle) const;

 private:
  struct Linear {
    double constant, slope;
  };
  int bands_;
  std::vector<std::vector<double>> logarithms_;  ///< by half-angle, in even steps up to pi/2
  std::vector<Linear> linear_;                   ///< by norm, in even steps
};

}  // namespace kiln
