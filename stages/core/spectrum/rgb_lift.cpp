// SPDX-License-Identifier: GPL-3.0-or-later
// [Jakob 2019], section 3: three coefficients per colour, found by Gauss-Newton. Colours are approached from grey in
// steps, so that each search begins near its end.

#include "spectrum/rgb_lift.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "spectrum/colorimetry.h"

namespace kiln {

namespace {

double scaled(double nanometres) { return (nanometres - first_wavelength_nm) / (wavelength_count - 1); }

}  // namespace

double SmoothReflectance::at(double nanometres) const {
  const double t = scaled(nanometres);
  const double x = (coefficients(0) * t + coefficients(1)) * t + coefficients(2);
  return 0.5 + x / (2 * std::hypot(1, x));
}

Spectrum SmoothReflectance::spectrum() const {
  Spectrum spectrum(wavelength_count);
  for (int i = 0; i < wavelength_count; ++i) spectrum(i) = at(wavelength_nm(i));
  return spectrum;
}

RgbLift::RgbLift(const StandardSpectra& standards) {
  const Spectrum daylight = standards.light("D65").values;
  const SpectrumMatrix observer = standards.observer(Observer::cie_1931);
  rgb_from_xyz_ = srgb_from_xyz(xyz_of(daylight, observer));
  weights_ = daylight.matrix().asDiagonal() * observer * rgb_from_xyz_.transpose();
}

Eigen::Vector3d RgbLift::albedo_of(const Spectrum& reflectance) const {
  return weights_.transpose() * reflectance.matrix();
}

SmoothReflectance RgbLift::lift(const Eigen::Vector3d& albedo) const {
  constexpr double margin = 1e-5;
  const Eigen::Vector3d target = albedo.cwiseMax(margin).cwiseMin(1 - margin);
  const double grey = target.mean();
  SmoothReflectance found;
  found.coefficients(2) = (grey - 0.5) / std::sqrt(grey * (1 - grey));
  if ((target.array() - grey).abs().maxCoeff() < 1e-12) return found;

  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(wavelength_count, 0, 1);
  SpectrumMatrix powers(wavelength_count, 3);
  powers << t.square().matrix(), t.matrix(), Eigen::VectorXd::Ones(wavelength_count);
  const auto miss = [&](const Eigen::Vector3d& coefficients, const Eigen::Vector3d& wanted) -> Eigen::Vector3d {
    const Eigen::ArrayXd x = (powers * coefficients).array();
    return wanted - albedo_of(0.5 + x / (2 * (1 + x.square()).sqrt()));
  };

  double reached = 0, stride = 0.25;
  while (reached < 1 && stride > 1e-6) {
    const double aim = std::min(1.0, reached + stride);
    const Eigen::Vector3d wanted = Eigen::Vector3d::Constant(grey) + aim * (target - Eigen::Vector3d::Constant(grey));
    Eigen::Vector3d coefficients = found.coefficients;
    Eigen::Vector3d residual = miss(coefficients, wanted);
    for (int round = 0; round < 20 && residual.cwiseAbs().maxCoeff() > 1e-9; ++round) {
      const Eigen::ArrayXd x = (powers * coefficients).array();
      const Eigen::ArrayXd slope = 0.5 / ((1 + x.square()) * (1 + x.square()).sqrt());
      const Eigen::Matrix3d jacobian = weights_.transpose() * slope.matrix().asDiagonal() * powers;
      const Eigen::Vector3d step = jacobian.inverse() * residual;
      double length = 1;
      Eigen::Vector3d next = miss(coefficients + step, wanted);
      while (!(next.norm() < residual.norm()) && length > 1e-3) {
        length /= 2;
        next = miss(coefficients + length * step, wanted);
      }
      if (!(next.norm() < residual.norm())) break;
      coefficients += length * step;
      residual = next;
    }
    if (residual.cwiseAbs().maxCoeff() < 1e-7) {
      found.coefficients = coefficients;
      reached = aim;
      stride *= 2;
    } else {
      stride /= 2;
    }
  }
  return found;
}

}  // namespace kiln
