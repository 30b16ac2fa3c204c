// SPDX-License-Identifier: GPL-3.0-or-later
#include "scatter/profile.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>

namespace kiln {

namespace {

constexpr double pi = std::numbers::pi;

/// Returns the average internal reflection of diffuse light at the boundary: the rational fit that [Jensen 2001]
/// quotes.
double internal_reflection(double eta) { return -1.440 / (eta * eta) + 0.710 / eta + 0.668 + 0.0636 * eta; }

/// Returns 1 - x e^-y for 0 <= x <= 1, given 1 - x, without cancellation.
double complement(double one_minus_x, double x, double y) { return one_minus_x - x * std::expm1(-y); }

}  // namespace

ScatterProfile ScatterProfile::dipole(double scattering_per_mm, double absorption_per_mm, double eta) {
  const double extinction = scattering_per_mm + absorption_per_mm;
  if (!(scattering_per_mm >= 0 && absorption_per_mm >= 0 && extinction > 0 && std::isfinite(extinction) && eta >= 1))
    throw std::invalid_argument("dipole: coefficients of 0 or more, not both 0, and eta of 1 or more are needed");
  const double reflection = internal_reflection(eta);
  const double boundary = (1 + reflection) / (1 - reflection);  // A
  ScatterProfile profile;
  profile.model_ = Model::dipole;
  profile.albedo_ = scattering_per_mm / extinction;
  profile.attenuation_ = std::sqrt(3 * (absorption_per_mm / extinction)) * extinction;
  profile.depth_[0] = 1 / extinction;
  profile.depth_[1] = profile.depth_[0] * (1 + 4.0 / 3.0 * boundary);
  return profile;
}

ScatterProfile ScatterProfile::diffusion(double surface_albedo, double mean_free_path_mm) {
  if (!(surface_albedo >= 0 && surface_albedo <= 1 && mean_free_path_mm > 0 && std::isfinite(mean_free_path_mm)))
    throw std::invalid_argument("diffusion: an albedo of 0 to 1 and a mean free path above 0 are needed");
  const double off = surface_albedo - 0.8;
  ScatterProfile profile;
  profile.model_ = Model::diffusion;
  profile.albedo_ = surface_albedo;
  profile.attenuation_ = (1.9 - surface_albedo + 3.5 * off * off) / mean_free_path_mm;
  return profile;
}

double ScatterProfile::density(double r_mm) const {
  if (model_ == Model::diffusion) {
    const double x = attenuation_ * r_mm;
    const double r = std::max(r_mm, 1e-150);
    return albedo_ * (attenuation_ / r) * (std::exp(-x) + std::exp(-x / 3)) / (8 * pi);
  }
  double sum = 0;
  for (const double z : depth_) {
    const double d = std::hypot(r_mm, z);
    const double decay = attenuation_ * d;
    // (z / d) / d^2 in two steps, so that neither power overflows.
    sum += z / d * (1 + decay) * std::exp(-decay) / d / d;
  }
  return albedo_ * sum / (4 * pi);
}

double ScatterProfile::within(double r_mm) const {
  if (model_ == Model::diffusion) {
    const double x = attenuation_ * r_mm;
    return -albedo_ * (std::expm1(-x) + 3 * std::expm1(-x / 3)) / 4;
  }
  double sum = 0;
  for (const double z : depth_) {
    const double d = std::hypot(r_mm, z);
    const double beyond = r_mm / (d + z) * r_mm;  // d - z
    sum += std::exp(-attenuation_ * z) * complement(beyond / d, z / d, attenuation_ * beyond);
  }
  return albedo_ * sum / 2;
}

double ScatterProfile::total() const {
  if (model_ == Model::diffusion) return albedo_;
  return albedo_ * (std::exp(-attenuation_ * depth_[0]) + std::exp(-attenuation_ * depth_[1])) / 2;
}

}  // namespace kiln
