#include "sh/lights.h"

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

void apply_hann_window(LightCoefficients& light) {
  for (std::vector<float>& channel : light.channels)
    for (std::size_t i = 0; i < channel.size(); ++i)
      channel[i] *=
          static_cast<float>(0.5 * (1 + std::cos(std::numbers::pi * band_of(static_cast<int>(i)) / light.bands)));
}

}  // namespace kiln
