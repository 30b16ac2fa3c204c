// SPDX-License-Identifier: MIT
#include "sh/lights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <numbers>

#include "sh/basis.h"

namespace kiln {

LightCoefficients directional_light(int bands, const Eigen::Vector3f& direction, std::span<const float> color) {
  return cone_light(bands, direction, 0, color);
}

LightCoefficients constant_light(int bands, std::span<const float> radiance) {
  LightCoefficients light{bands, {}};
  for (float level : radiance) {
    std::vector<float>& channel = light.channels.emplace_back(coefficient_count(bands), 0.f);
    channel[0] = static_cast<float>(level * std::sqrt(4 * std::numbers::pi));
  }
  return light;
}

std::vector<double> cone_bands(int bands, double half_angle) {
  // For a thin cone the closed form loses its digits to cancellation; a directional light is accurate enough.
  if (half_angle < 1e-3) return std::vector<double>(static_cast<std::size_t>(bands), std::numbers::pi);
  const double cosine = std::cos(std::min(half_angle, std::numbers::pi));
  const double brightness = cosine > 0 ? 1 / (1 - cosine * cosine) : 1;
  // The integral of P_l over [cosine, 1] is (P_(l-1)(cosine) - P_(l+1)(cosine)) / (2l + 1).
  std::vector<double> zonal(bands);
  double before = 1, p = 1;  // P_(l-1), with P_(-1) = 1, and P_l
  for (int l = 0; l < bands; ++l) {
    const double after = ((2 * l + 1) * cosine * p - l * (l == 0 ? 0 : before)) / (l + 1);
    zonal[l] = 2 * std::numbers::pi * brightness * (before - after) / (2 * l + 1);
    before = p;
    p = after;
  }
  return zonal;
}

LightCoefficients cone_light(int bands, const Eigen::Vector3f& direction, double half_angle,
                             std::span<const float> color) {
  const std::vector<double> zonal = cone_bands(bands, half_angle);
  const ShBasis basis(bands);
  std::vector<double> values(basis.size());
  basis.evaluate<double>(direction.cast<double>().normalized(), values);
  LightCoefficients light{bands, {}};
  for (const float level : color) {
    std::vector<float>& channel = light.channels.emplace_back(basis.size());
    for (int i = 0; i < basis.size(); ++i) channel[i] = static_cast<float>(level * zonal[band_of(i)] * values[i]);
  }
  return light;
}

LightCoefficients sphere_light(int bands, const Eigen::Vector3f& position, double radius,
                               std::span<const float> color) {
  const double distance = position.cast<double>().norm();
  if (distance <= radius) return constant_light(bands, color);
  return cone_light(bands, position, std::asin(radius / distance), color);
}

LightCoefficients hemisphere_light(int bands, const Eigen::Vector3f& up, std::span<const float> sky,
                                   std::span<const float> ground) {
  assert(sky.size() == ground.size());
  const Eigen::Vector3d axis = up.cast<double>().normalized();
  LightCoefficients light{bands, {}};
  for (std::size_t c = 0; c < sky.size(); ++c) {
    std::vector<float>& channel = light.channels.emplace_back(coefficient_count(bands), 0.f);
    channel[0] = static_cast<float>(0.5 * (sky[c] + ground[c]) * std::sqrt(4 * std::numbers::pi));
    if (bands == 1) continue;
    const double slope = 0.5 * (sky[c] - ground[c]) * std::sqrt(4 * std::numbers::pi / 3);
    for (int k = 0; k < 3; ++k) channel[1 + k] = static_cast<float>(slope * axis[(k + 1) % 3]);  // y, z, x
  }
  return light;
}

LightCoefficients add_lights(const LightCoefficients& a, const LightCoefficients& b) {
  assert(a.bands == b.bands && a.channels.size() == b.channels.size());
  LightCoefficients sum = a;
  for (std::size_t c = 0; c < sum.channels.size(); ++c)
    for (std::size_t i = 0; i < sum.channels[c].size(); ++i) sum.channels[c][i] += b.channels[c][i];
  return sum;
}

LightCoefficients scale_light(const LightCoefficients& light, double factor) {
  LightCoefficients scaled = light;
  for (std::vector<float>& channel : scaled.channels)
    for (float& value : channel) value = static_cast<float>(factor * value);
  return scaled;
}

double dot_product(std::span<const float> f, std::span<const float> g) {
  assert(f.size() == g.size());
  double sum = 0;
  for (std::size_t i = 0; i < f.size(); ++i) sum += static_cast<double>(f[i]) * g[i];
  return sum;
}

double evaluate_at(std::span<const float> coefficients, const Eigen::Vector3f& direction) {
  const ShBasis basis(band_of(static_cast<int>(coefficients.size()) - 1) + 1);
  std::vector<double> values(basis.size());
  basis.evaluate<double>(direction.cast<double>(), values);
  double sum = 0;
  for (std::size_t i = 0; i < coefficients.size(); ++i) sum += coefficients[i] * values[i];
  return sum;
}

LightCoefficients irradiance(const LightCoefficients& light) {
  const std::vector<double> factors = clamped_cosine_bands(light.bands);
  LightCoefficients result = light;
  for (std::vector<float>& channel : result.channels)
    for (std::size_t i = 0; i < channel.size(); ++i)
      channel[i] = static_cast<float>(channel[i] * factors[static_cast<std::size_t>(band_of(static_cast<int>(i)))]);
  return result;
}

}  // namespace kiln
