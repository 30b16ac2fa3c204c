// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/options.h"
#include "runtime/light/scene_lights.h"
#include "sh/light_spec.h"
#include "sh/windows.h"

namespace kiln {

/// Lights of a picture; they add up.
struct LightSettings {
  std::vector<std::string> lights;          ///< as for parse_light_spec; "45,30" if there is no light at all
  std::string ambient = "none";             ///< radiance from everywhere, one number or R,G,B
  std::filesystem::path environment;        ///< as for load_environment; empty: none
  double environment_rotation_degrees = 0;  ///< about +Y
  LightWindow window = LightWindow::hann;
};

/// Makes the options for lights, except the lights themselves and the environment.
OptionSet light_options(LightSettings& settings);

/// Parses the lights of `settings`, without the environment. Throws WrongUsage.
std::vector<LightSpec> light_specs(const LightSettings& settings);

/// Collects all lights of `settings`, an environment in `bands`. Throws WrongUsage, BadInput.
SceneLights scene_lights(const LightSettings& settings, int bands);

}  // namespace kiln
