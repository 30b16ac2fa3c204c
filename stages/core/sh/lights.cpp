#include "sh/lights.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>

#include "sh/basis.h"

namespace kiln {

LightCoefficients directional_light(int bands, const Eigen::Vector3f& direction, std::span<const float> colour) {
  const ShBasis basis(bands);
  std::vector<double> values(basis.size());
  basis.evaluate<double>(direction.cast<double>().normalized(), values);
  LightCoefficients light{bands, {}};
  for (float level : colour) {
    std::vector<float>& channel = light.channels.emplace_back(basis.size());
    for (int i = 0; i < basis.size(); ++i) channel[i] = static_cast<float>(std::numbers::pi * level * values[i]);
  }
  return light;
}

LightCoefficients constant_light(int bands, std::span<const float> radiance) {
  LightCoefficients light{bands, {}};
  for (float level : radiance) {
    std::vector<float>& channel = light.channels.emplace_back(coefficient_count(bands), 0.f);
    channel[0] = static_cast<float>(level * std::sqrt(4 * std::numbers::pi));
  }
  return light;
}

LightCoefficients latitude_longitude_light(int bands, int width, int height, int channels,
                                           std::span<const float> pixels) {
  assert(pixels.size() == static_cast<std::size_t>(width) * height * channels);
  const ShBasis basis(bands);
  std::vector<double> values(basis.size());
  std::vector<std::vector<double>> sums(channels, std::vector<double>(basis.size(), 0.0));
  for (int j = 0; j < height; ++j) {
    const double lower = std::numbers::pi * (static_cast<double>(j) / height - 0.5);
    const double upper = std::numbers::pi * (static_cast<double>(j + 1) / height - 0.5);
    const double solid_angle = 2 * std::numbers::pi / width * (std::sin(upper) - std::sin(lower));
    const double elevation = 0.5 * (lower + upper);
    for (int i = 0; i < width; ++i) {
      const double azimuth = 2 * std::numbers::pi * ((i + 0.5) / width - 0.5);
      basis.evaluate<double>(Eigen::Vector3d(std::cos(elevation) * std::cos(azimuth), std::sin(elevation),
                                             std::cos(elevation) * std::sin(azimuth)),
                             values);
      for (int channel = 0; channel < channels; ++channel) {
        const double weight = solid_angle * pixels[(static_cast<std::size_t>(j) * width + i) * channels + channel];
        for (int k = 0; k < basis.size(); ++k) sums[channel][k] += weight * values[k];
      }
    }
  }
  LightCoefficients light{bands, {}};
  for (const std::vector<double>& sum : sums) light.channels.emplace_back(sum.begin(), sum.end());
  return light;
}

LightCoefficients cone_light(int bands, const Eigen::Vector3f& direction, double half_angle,
                             std::span<const float> colour) {
  // Of a thin cone the closed form has lost its digits; it is as good as a point.
  if (half_angle < 1e-3) return directional_light(bands, direction, colour);
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
  const ShBasis basis(bands);
  std::vector<double> values(basis.size());
  basis.evaluate<double>(direction.cast<double>().normalized(), values);
  LightCoefficients light{bands, {}};
  for (const float level : colour) {
    std::vector<float>& channel = light.channels.emplace_back(basis.size());
    for (int i = 0; i < basis.size(); ++i) channel[i] = static_cast<float>(level * zonal[band_of(i)] * values[i]);
  }
  return light;
}

LightCoefficients sphere_light(int bands, const Eigen::Vector3f& position, double radius,
                               std::span<const float> colour) {
  const double distance = position.cast<double>().norm();
  if (distance <= radius) return constant_light(bands, colour);
  return cone_light(bands, position, std::asin(radius / distance), colour);
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

LightCoefficients cube_map_light(int bands, int size, int channels, std::span<const std::span<const float>, 6> faces) {
  // Direction of a face's centre, and of growing s and t.
  struct FaceAxes {
    Eigen::Vector3d centre, s, t;
  };
  static const std::array<FaceAxes, 6> axes = {{{{1, 0, 0}, {0, 0, -1}, {0, -1, 0}},
                                                {{-1, 0, 0}, {0, 0, 1}, {0, -1, 0}},
                                                {{0, 1, 0}, {1, 0, 0}, {0, 0, 1}},
                                                {{0, -1, 0}, {1, 0, 0}, {0, 0, -1}},
                                                {{0, 0, 1}, {1, 0, 0}, {0, -1, 0}},
                                                {{0, 0, -1}, {-1, 0, 0}, {0, -1, 0}}}};
  // The solid angle of the part of a face from its centre to (s, t).
  const auto corner = [](double s, double t) { return std::atan2(s * t, std::sqrt(s * s + t * t + 1)); };
  const ShBasis basis(bands);
  std::vector<double> values(basis.size());
  std::vector<std::vector<double>> sums(channels, std::vector<double>(basis.size(), 0.0));
  for (std::size_t face = 0; face < faces.size(); ++face) {
    assert(faces[face].size() == static_cast<std::size_t>(size) * size * channels);
    for (int j = 0; j < size; ++j)
      for (int i = 0; i < size; ++i) {
        const double s0 = 2.0 * i / size - 1, s1 = 2.0 * (i + 1) / size - 1;
        const double t0 = 2.0 * j / size - 1, t1 = 2.0 * (j + 1) / size - 1;
        const double solid_angle = corner(s1, t1) - corner(s0, t1) - corner(s1, t0) + corner(s0, t0);
        const Eigen::Vector3d direction =
            axes[face].centre + 0.5 * (s0 + s1) * axes[face].s + 0.5 * (t0 + t1) * axes[face].t;
        basis.evaluate<double>(direction.normalized(), values);
        for (int channel = 0; channel < channels; ++channel) {
          const double weight =
              solid_angle * faces[face][(static_cast<std::size_t>(j) * size + i) * channels + channel];
          for (int k = 0; k < basis.size(); ++k) sums[channel][k] += weight * values[k];
        }
      }
  }
  LightCoefficients light{bands, {}};
  for (const std::vector<double>& sum : sums) light.channels.emplace_back(sum.begin(), sum.end());
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
