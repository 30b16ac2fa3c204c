// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/view_state.h"

#include <algorithm>
#include <cmath>

namespace kiln {

bool ViewLimits::allows(Technique technique) const {
  return std::find(techniques.begin(), techniques.end(), technique) != techniques.end();
}

void limit(ViewState& state, const ViewLimits& limits) {
  if (!limits.allows(state.technique)) state.technique = limits.techniques.front();
  state.bands = std::clamp(state.bands, 1, limits.bands);
  state.coefficient = std::clamp(state.coefficient, 0, limits.coefficients() - 1);
  const bool lacks =
      (state.show == Show::difference && !limits.has_reference) || (state.show == Show::charts && !limits.has_charts);
  if (lacks) state.show = Show::picture;
  state.light.environment = state.light.environment && limits.has_environment;
  state.light.lamp = std::clamp(state.light.lamp, 0, std::max(0, limits.lamps - 1));
}

bool can_defer(Technique technique) {
  return technique == Technique::textured_prt || technique == Technique::compressed;
}

void drag(ViewState& state, Drag what, double right_pixels, double down_pixels, std::span<const Eigen::Vector3f> shape,
          int width, int height) {
  constexpr double light_degrees_per_pixel = 0.4;
  switch (what) {
    case Drag::orbit:
      turn_orbit(state.orbit, right_pixels, down_pixels);
      break;
    case Drag::pan:
      pan_orbit(state.orbit, shape, right_pixels, down_pixels, width, height);
      break;
    case Drag::light:
      state.light.azimuth_degrees =
          std::remainder(state.light.azimuth_degrees + light_degrees_per_pixel * right_pixels, 360);
      state.light.elevation_degrees =
          std::clamp(state.light.elevation_degrees - light_degrees_per_pixel * down_pixels, -90.0, 90.0);
      break;
  }
}

}  // namespace kiln
