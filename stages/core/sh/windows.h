// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "sh/lights.h"

namespace kiln {

/// Ways to weight the bands of a light against ringing. All leave band 0, and with it ambient light, unchanged; a light
/// that a white surface can face is then scaled as a whole (axial_weights).
enum class LightWindow {
  none,
  hann,     ///< (1 + cos(pi l / bands)) / 2
  lanczos,  ///< sin(x) / x, x = pi l / bands
  dering,   ///< the weakest window that leaves no negative radiance (deringing_window)
};

/// Returns the weight of each band ([Sloan 2008], "Windowing").
std::vector<double> hann_window(int bands);
std::vector<double> lanczos_window(int bands);

/// Returns the weakest window of the family 1 / (1 + s l^2 (l + 1)^2), s >= 0, under which no channel is negative
/// anywhere, by bisection [Sloan 2017]; the family damps the squared Laplacian [Sloan 2008]. All weights are 1 where
/// nothing is negative. A channel whose mean is negative is ignored: no window helps there.
std::vector<double> deringing_window(const LightCoefficients& light);

/// Returns the radiance of an unshadowed white surface that faces a light around one axis: the sum of z_l A_l (2l + 1)
/// / (4 pi^2), where z_l Y_lm(axis) are the light's coefficients and A_l the bands of the clamped cosine.
double facing_radiance(std::span<const double> zonal);

/// Returns the factors of the bands of such a light: the weights of `window`, all scaled so that the facing surface has
/// the radiance `facing`, whatever window and truncation did to it. deringing_window is found on the meridian of the
/// axis.
std::vector<double> axial_weights(std::span<const double> zonal, LightWindow window, double facing);

/// Returns the weights of `window` for a light without such an axis: ones, hann_window, lanczos_window or
/// deringing_window.
std::vector<double> window_weights(const LightCoefficients& light, LightWindow window);

/// Returns the least value over the sphere of a function in spherical harmonics: the least of many directions, followed
/// downhill to within 1e-6 of the function's largest coefficient.
double smallest_value(std::span<const float> coefficients);

/// Multiplies every band by its weight.
void apply_window(LightCoefficients& light, std::span<const double> window);

}  // namespace kiln
