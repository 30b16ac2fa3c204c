// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sh/lights.h"

namespace kiln {

/// Returns S_l, the second moments of a light's coefficients over all of its rotations, by band: the sum over m of
/// L_lm^2 / (2l + 1), in the mean over channels. An even turn makes all coefficients of a band alike and unrelated to
/// one another, so the moments are a diagonal matrix with one value per band.
std::vector<double> band_moments(const LightCoefficients& light);

/// Returns the square of the exit radiance of an unshadowed white surface, in the mean over its normals, under light of
/// these moments: the sum of (2l + 1) / (4 pi) (A_l / pi)^2 S_l, with A_l of clamped_cosine_bands.
double unshadowed_exit_square(std::span<const double> moments);

/// Returns the prior over light: its second moments by band, measured on photographed, sky and studio light and divided
/// by that of band 0, since only the ratios between bands matter. docs/error.md has the measurement, tools/prior makes
/// it. Bands 0 to 3 are the measured ones; above, power laws join the means of octaves, the last of which goes on
/// beyond band 63.
std::vector<double> lighting_prior(int bands);

/// Bands that lighting_prior was measured for.
constexpr int measured_prior_bands = 64;

}  // namespace kiln
