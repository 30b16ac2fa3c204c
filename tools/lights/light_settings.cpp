// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/light_settings.h"

#include "base/numbers.h"
#include "runtime/light/environment.h"

namespace kiln {

OptionSet light_options(LightSettings& settings) {
  OptionSet options;
  options.text("ambient", settings.ambient, "Radiance from everywhere (a furnace): one number or R,G,B")
      .number("environment-rotation", settings.environment_rotation_degrees, -360, 360,
              "Turns the environment about +Y, degrees: what was at azimuth a comes to a + this")
      .choice(
          "window", settings.window,
          {{"hann", LightWindow::hann},
           {"lanczos", LightWindow::lanczos},
           {"dering", LightWindow::dering},
           {"none", LightWindow::none}},
          "Weights the bands of each light, which tames ringing and blurs; what faces the light keeps its radiance, "
          "and "
          "ambient light stays as it is. With 5 bands the edge of a shadow takes 33 degrees under none (which rings by "
          "10 %), 51 under lanczos, 63 under hann and 93 under dering, the weakest of its family that leaves no "
          "negative light");
  return options;
}

std::vector<LightSpec> light_specs(const LightSettings& settings) {
  std::vector<LightSpec> specs;
  for (const std::string& text : settings.lights) specs.push_back(parse_light_spec(text));
  if (settings.ambient != "none")
    specs.push_back({.kind = LightSpec::Kind::ambient, .color = parse_color("ambient", settings.ambient, 0, 1e6)});
  if (specs.empty() && settings.environment.empty()) specs.emplace_back();
  return specs;
}

SceneLights scene_lights(const LightSettings& settings, int bands) {
  SceneLights lights{light_specs(settings), std::nullopt, settings.window};
  if (!settings.environment.empty())
    // Three bands at least, for shading without harmonics.
    lights.environment =
        load_environment(settings.environment, std::max(3, bands), settings.environment_rotation_degrees);
  return lights;
}

}  // namespace kiln
