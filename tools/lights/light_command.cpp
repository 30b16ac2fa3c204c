// SPDX-License-Identifier: GPL-3.0-or-later
#include "lights/light_command.h"

#include "base/command_line.h"
#include "base/errors.h"
#include "lights/light_file.h"

namespace kiln {

void add_light_options(CommandLine& command, LightSettings& settings, std::filesystem::path& light_file) {
  command.list_option("light", settings.lights, "Light",
                      "A light, degrees: AZIMUTH,ELEVATION[,R,G,B] (0,0 is +Z; 90,0 is +X; a white surface that faces "
                      "it has radiance 1, or R,G,B, under any window), cone:AZIMUTH,ELEVATION,HALF-ANGLE[,R,G,B], "
                      "sphere:X,Y,Z,RADIUS[,R,G,B] (a ball; that radiance at the origin), "
                      "hemisphere:AZIMUTH,ELEVATION,R,G,B,R,G,B (above, below) or ambient:RADIANCE; may be repeated "
                      "(default 45,30 if there is no other)");
  command.input_option(
      "environment", settings.environment,
      "A latitude-longitude picture of radiance of any size, EXR or HDR, or a folder of the six faces of "
      "a cube map, px to nz");
  command.input_option("light-file", light_file, "All of the lights, in a JSON file (tools/render/README.md)");
  command.options("Light", light_options(settings));
}

LightSettings chosen_lights(const LightSettings& settings, const std::filesystem::path& light_file) {
  if (light_file.empty()) return settings;
  if (!settings.lights.empty() || settings.ambient != "none" || !settings.environment.empty())
    throw WrongUsage("light-file: found lights on the command line, too; expected one or the other");
  return read_light_file(light_file);
}

}  // namespace kiln
