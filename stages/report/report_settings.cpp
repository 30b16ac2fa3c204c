#include "report/report_settings.h"

#include <sstream>

namespace kiln {

OptionSet report_options(ReportSettings& settings) {
  OptionSet options;
  options.text(
      "lights", settings.lights,
      "Lights to show the asset under, as kiln-render takes them, separated by ';': AZIMUTH,ELEVATION in degrees, "
      "ambient:RADIANCE, or an environment picture");
  options.number("camera-azimuth", settings.camera_azimuth_degrees, -360, 360,
                 "Where the camera stands, in degrees: 0 is +Z, 90 is +X");
  options.number("camera-elevation", settings.camera_elevation_degrees, -90, 90,
                 "Of the camera above the horizon, in degrees");
  options.integer("picture-size", settings.picture_size, 64, 2048, "Of the rendered pictures, pixels a side");
  options.integer("directions", settings.directions, 16, 65536, "Directions of the reference's transfer integral");
  options.number("albedo", settings.albedo, 0, 1, "Share of the light that the surface reflects");
  options.text("gl-device", settings.gl_device, "EGL device to draw on: auto, software, or its number");
  return options;
}

std::vector<std::string> list_of_lights(const ReportSettings& settings) {
  constexpr const char* blanks = " \t";
  std::vector<std::string> lights;
  std::istringstream text(settings.lights);
  for (std::string light; std::getline(text, light, ';');) {
    const std::size_t first = light.find_first_not_of(blanks);
    if (first != std::string::npos) lights.push_back(light.substr(first, light.find_last_not_of(blanks) - first + 1));
  }
  return lights;
}

}  // namespace kiln
