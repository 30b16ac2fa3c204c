// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "spectrum/spectrum.h"
#include "spectrum/standards.h"

namespace kiln {

/// Smooth reflectance of [Jakob 2019]: 1/2 + x / (2 sqrt(1 + x^2)) with x a polynomial of second degree in wavelength,
/// so it is within 0 to 1 everywhere. Coefficients are those of ((nm - 360) / 470)^2, ^1 and ^0.
struct SmoothReflectance {
  Eigen::Vector3d coefficients = Eigen::Vector3d::Zero();

  double at(double nanometres) const;
  Spectrum spectrum() const;
};

/// Lifts albedos of red, green and blue to smooth reflectances that have that colour under D65 for the 1931 observer.
class RgbLift {
 public:
  explicit RgbLift(const StandardSpectra& standards);

  /// Returns the reflectance of a linear sRGB albedo, each channel 0 to 1. Its colour under D65 is the albedo within
  /// 1e-5 per channel; channels below 1e-5 or above 1 - 1e-5, which no finite coefficients have, are moved there.
  SmoothReflectance lift(const Eigen::Vector3d& albedo) const;

  /// Returns the linear sRGB albedo of a reflectance under D65: what an artist who sees it in daylight would paint. Not
  /// clamped: of saturated surfaces a channel may be below 0.
  Eigen::Vector3d albedo_of(const Spectrum& reflectance) const;

  /// Returns the matrix from X, Y and Z of the 1931 observer to the red, green and blue of these albedos.
  const Eigen::Matrix3d& rgb_from_xyz() const { return rgb_from_xyz_; }

 private:
  Eigen::Matrix3d rgb_from_xyz_;
  SpectrumMatrix weights_;  ///< a column for each of red, green and blue: response times D65; white is 1, 1, 1
};

}  // namespace kiln
