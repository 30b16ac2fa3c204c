#pragma once

#include <span>
#include <vector>

#include "sh/lights.h"

namespace kiln {

/// How the bands of a light are weighted against ringing. All leave band 0, and with it ambient light, as it is.
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

/// The least value over the sphere of a function in spherical harmonics: the least of many directions, followed
/// downhill to within 1e-6 of the function's largest coefficient.
double smallest_value(std::span<const float> coefficients);

/// Multiplies every band by its weight.
void apply_window(LightCoefficients& light, std::span<const double> window);
void apply_window(LightCoefficients& light, LightWindow window);

}  // namespace kiln
