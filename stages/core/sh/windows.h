#pragma once

#include <span>
#include <vector>

#include "sh/lights.h"

namespace kiln {

/// How the bands of a light are weighted against ringing. All leave band 0, and with it ambient light, as it is; lights
/// that a white surface can face are then scaled as a whole (axial_weights).
enum class LightWindow {
  none,
  hann,     ///< (1 + cos(pi l / bands)) / 2
  lanczos,  ///< sin(x) / x, x = pi l / bands
  dering,   ///< the weakest window that leaves no negative radiance (deringing_window)
};

/// Weight of each band, after Sloan, "Stupid spherical harmonics (SH) tricks", 2008, "Windowing".
std::vector<double> hann_window(int bands);
std::vector<double> lanczos_window(int bands);

/// Weights of the bands, the weakest of the family 1 / (1 + s l^2 (l + 1)^2), s >= 0, under which no channel is
/// negative anywhere, by bisection: Sloan, "Deringing spherical harmonics", SIGGRAPH Asia 2017 technical briefs; the
/// family damps the squared Laplacian (Sloan 2008). Ones where nothing is negative. Where a channel's mean is negative
/// no window helps, and it is left out of account.
std::vector<double> deringing_window(const LightCoefficients& light);

/// The radiance of a white surface that faces a light around one axis and that nothing shadows: the sum of z_l A_l
/// (2l + 1) / (4 pi^2), where z_l Y_lm(axis) are the light's coefficients and A_l the bands of the clamped cosine.
double facing_radiance(std::span<const double> zonal);

/// What the bands of such a light are multiplied with: the weights of `window` for as many bands, all times the number
/// that gives the facing surface the radiance `facing`, whatever the window and the truncation took from or added to
/// it. deringing_window, of a light around an axis, is found on the axis' meridian.
std::vector<double> axial_weights(std::span<const double> zonal, LightWindow window, double facing);

/// The weights of `window` for a light without such an axis: ones, hann_window, lanczos_window or deringing_window.
std::vector<double> window_weights(const LightCoefficients& light, LightWindow window);

/// The least value over the sphere of a function in spherical harmonics: the least of many directions, followed
/// downhill to within 1e-6 of the function's largest coefficient.
double smallest_value(std::span<const float> coefficients);

/// Multiplies every band by its weight.
void apply_window(LightCoefficients& light, std::span<const double> window);

}  // namespace kiln
