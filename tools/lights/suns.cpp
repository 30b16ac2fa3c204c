// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/suns.h"

#include <algorithm>

#include "spectrum/sun_position.h"

namespace kiln {

bool has_suns(const LightSettings& settings) { return std::ranges::any_of(settings.lights, &is_sun_hour); }

LightSettings with_placed_suns(LightSettings settings) {
  for (std::string& light : settings.lights) {
    if (!is_sun_hour(light)) continue;
    const SunHour hour = parse_sun_hour(light);
    const SunPosition sun = visible_sun(hour);
    LightSpec spec;
    spec.azimuth_degrees = scene_azimuth(hour, sun);
    spec.elevation_degrees = sun.elevation_degrees;
    light = to_text(spec);
  }
  return settings;
}

}  // namespace kiln
