#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Incident radiance in spherical harmonics: coefficients[channel][i], channels of colour or of a spectral basis.
struct LightCoefficients {
  int bands = 0;
  std::vector<std::vector<float>> channels;
};

/// A distant light in `direction` (towards the light) that gives a white surface which faces it the radiance `colour`:
/// the irradiance is pi times that. One channel per entry of `colour`.
LightCoefficients directional_light(int bands, const Eigen::Vector3f& direction, std::span<const float> colour);

/// The same radiance from everywhere (a furnace).
LightCoefficients constant_light(int bands, std::span<const float> radiance);

/// A latitude-longitude picture of radiance, each pixel weighted by its solid angle. `pixels` has rows from the bottom
/// (-Y first), channels interleaved; u = atan2(z, x) / 2 pi + 1/2 runs to the right, v = elevation / pi + 1/2 upwards
/// (three.js' convention).
LightCoefficients latitude_longitude_light(int bands, int width, int height, int channels,
                                           std::span<const float> pixels);

/// Multiplies band l by the Hann window (1 + cos(pi l / bands)) / 2, which tames ringing at the price of sharpness
/// (Sloan, "Stupid spherical harmonics tricks", 2008, "Windowing").
void apply_hann_window(LightCoefficients& light);

}  // namespace kiln
