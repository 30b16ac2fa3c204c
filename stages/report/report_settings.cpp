// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_settings.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "base/number_text.h"

namespace kiln {

namespace {

/// Parses `albedo`; returns nothing for auto.
std::optional<double> parse_albedo(const std::string& text) {
  if (text == "auto") return std::nullopt;
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !(value >= 0 && value <= 1))
    throw WrongUsage("albedo: found '" + text + "'; expected auto or a number, 0 to 1");
  return value;
}

/// Parses `error-bounces`; returns nothing for baked.
std::optional<int> parse_error_bounces(const std::string& text) {
  if (text == "baked") return std::nullopt;
  int value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || value < 0 || value > 100)
    throw WrongUsage("error-bounces: found '" + text + "'; expected baked or a whole number, 0 to 100");
  return value;
}

}  // namespace

std::map<std::string, double> ReportSettings::predictions() const {
  std::map<std::string, double> result;
  for (const std::string& entry : list_of(predicted)) {
    const std::size_t equals = entry.find('=');
    double value = 0;
    const char* const begin = entry.data() + std::min(equals, entry.size() - 1) + 1;
    const auto [end, error] = std::from_chars(begin, entry.data() + entry.size(), value);
    if (equals == std::string::npos || error != std::errc() || end != entry.data() + entry.size())
      throw WrongUsage("predicted: found '" + entry + "'; expected NAME=NUMBER");
    result[entry.substr(0, equals)] = value;
  }
  return result;
}

double ReportSettings::albedo_factor(bool asset_has_albedo) const {
  return albedo.value_or(asset_has_albedo ? 1 : 0.8);
}

OptionSet report_options(ReportSettings& settings) {
  OptionSet options;
  options.text(
      "lights", settings.lights,
      "Lights to show the asset under, as kiln-render takes them, separated by ';': AZIMUTH,ELEVATION in degrees, "
      "ambient:RADIANCE, or an environment picture");
  options.number("camera-azimuth", settings.camera_azimuth_degrees, -360, 360,
                 "Where the camera stands, in degrees: 0 is +Z, which is the front whatever --up was; 90 is +X");
  options.number("camera-elevation", settings.camera_elevation_degrees, -90, 90,
                 "Of the camera above the horizon, in degrees");
  options.integer("cameras", settings.cameras, 1, 16,
                  "Cameras evenly around the asset, the first where --camera-azimuth says; the others show the first "
                  "light, turned with them");
  add_framing_options(options, settings.framing);
  options.integer("picture-size", settings.picture_size, 64, 2048, "Of the rendered pictures, pixels a side");
  options.integer("directions", settings.directions, 16, 65536, "Directions of the reference's transfer integral");
  options.typed<std::optional<double>>(
      "albedo", settings.albedo, "auto or 0 to 1",
      "Share of the light that surfaces reflect, times the asset's own albedo; auto: 1 where it has "
      "one, else 0.8",
      parse_albedo, [](const std::optional<double>& albedo) { return albedo ? numbers_text({*albedo}) : "auto"; });
  options.text("gl-device", settings.gl_device, "EGL device to draw on: auto, software, or its number");
  options.text(
      "error-lights", settings.error_lights,
      "Light that the asset's error is expected under, turned evenly: measured, for the prior of docs/error.md, "
      "or lights as above, each as likely as the others");
  options.number("error-pixels", settings.error_pixels, 0, 1e6,
                 "The longest side of the asset's box as viewers see it, in pixels, over which errors are averaged; 0: "
                 "however near");
  options.integer("error-samples", settings.error_samples, 64, 1000000, "Pixels that the error is measured at");
  options.typed<std::optional<int>>(
      "error-bounces", settings.error_bounces, "baked or 0 to 100",
      "How often light bounces in what the error is measured against; baked: as often as in the bake",
      parse_error_bounces,
      [](const std::optional<int>& bounces) { return bounces ? std::to_string(*bounces) : "baked"; });
  options.toggle(
      "error-others", settings.error_others,
      "Measure as well what the asset would cost otherwise: with transfer at the vertices of the low mesh in "
      "place of texels (error.at_vertices), and without shadows (error.unshadowed); `kiln plan` asks for it");
  options.text("predicted", settings.predicted,
               "What `kiln plan` predicted, to show beside what is measured: 'total=0.008; geometry=0.004; ...'");
  return options;
}

std::vector<std::string> list_of(const std::string& text_of_all) {
  constexpr const char* blanks = " \t";
  std::vector<std::string> entries;
  std::istringstream text(text_of_all);
  for (std::string entry; std::getline(text, entry, ';');) {
    const std::size_t first = entry.find_first_not_of(blanks);
    if (first != std::string::npos) entries.push_back(entry.substr(first, entry.find_last_not_of(blanks) - first + 1));
  }
  return entries;
}

}  // namespace kiln
