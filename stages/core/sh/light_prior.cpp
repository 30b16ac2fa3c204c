// SPDX-License-Identifier: MIT
#include "sh/light_prior.h"

#include <array>
#include <cmath>
#include <numbers>

#include "sh/basis.h"

namespace kiln {

namespace {

/// Band and its second moment, relative to that of band 0.
struct Knot {
  double band, moment;
};

/// Knots of the prior as light-prior prints them: bands 1 to 3, then the means of the octaves 4 to 7, 8 to 15, 16 to 31
/// and 32 to 63.
constexpr std::array<Knot, 7> knots = {
    {{1, 0.2697}, {2, 0.1536}, {3, 0.1402}, {5.596, 0.1285}, {11.71, 0.1035}, {23.94, 0.0873}, {48.40, 0.0664}}};

}  // namespace

std::vector<double> band_moments(const LightCoefficients& light) {
  std::vector<double> moments(light.bands, 0.0);
  for (const std::vector<float>& channel : light.channels)
    for (int i = 0; i < coefficient_count(light.bands); ++i)
      moments[band_of(i)] += static_cast<double>(channel[i]) * channel[i];
  for (int l = 0; l < light.bands; ++l) moments[l] /= static_cast<double>(light.channels.size()) * (2 * l + 1);
  return moments;
}

double unshadowed_exit_square(std::span<const double> moments) {
  const int bands = static_cast<int>(moments.size());
  const std::vector<double> cosine = clamped_cosine_bands(bands);
  double square = 0;
  for (int l = 0; l < bands; ++l) square += (2 * l + 1) * cosine[l] * cosine[l] * moments[l];
  return square / (4 * std::numbers::pi * std::numbers::pi * std::numbers::pi);
}

std::vector<double> lighting_prior(int bands) {
  std::vector<double> prior(bands, 1.0);
  std::size_t k = 0;  // knot before the band
  for (int l = 1; l < bands; ++l) {
    while (k + 2 < knots.size() && l > knots[k + 1].band) ++k;
    const double slope = std::log(knots[k + 1].moment / knots[k].moment) / std::log(knots[k + 1].band / knots[k].band);
    prior[l] = knots[k].moment * std::pow(l / knots[k].band, slope);
  }
  return prior;
}

}  // namespace kiln
