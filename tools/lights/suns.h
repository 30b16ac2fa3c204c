// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "lights/light_settings.h"

namespace kiln {

/// Tests whether a light is the sun at an hour, which has a spectrum of its own (spectrum/sun_position.h).
bool has_suns(const LightSettings& settings);

/// Returns the lights with each sun at an hour as the directional light from where it stands. Throws WrongUsage for
/// texts that are none, and where the sun is below the horizon.
LightSettings with_placed_suns(LightSettings settings);

}  // namespace kiln
