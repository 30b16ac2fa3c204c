// SPDX-License-Identifier: MIT
#include "base/framing_options.h"

#include <vector>

#include "base/numbers.h"

namespace kiln {

namespace {

constexpr double farthest = 1e12;

std::optional<std::array<double, 3>> parse_target(const std::string& text) {
  if (text == "auto") return std::nullopt;
  const std::vector<double> numbers = parse_numbers("target", text, -farthest, farthest);
  if (numbers.size() != 3) throw WrongUsage("target: found '" + text + "'; expected auto, or X,Y,Z");
  return std::array{numbers[0], numbers[1], numbers[2]};
}

double parse_distance(const std::string& text) {
  if (text == "auto") return 0;
  const std::vector<double> numbers = parse_numbers("distance", text, 0, farthest);
  if (numbers.size() != 1 || numbers[0] <= 0)
    throw WrongUsage("distance: found '" + text + "'; expected auto, or a number above 0");
  return numbers[0];
}

}  // namespace

std::optional<std::array<double, 3>> FramingSettings::target_place() const { return parse_target(target); }

double FramingSettings::target_distance() const { return parse_distance(distance); }

void add_framing_options(OptionSet& options, FramingSettings& settings) {
  options
      .number("zoom", settings.zoom, 0.01, 1000,
              "Magnifies the middle of the picture so many times; the camera stays where it is")
      .checked_text("target", settings.target, "auto or X,Y,Z",
                    "The point in the middle of the picture, object units; auto: the middle of the silhouette",
                    [](const std::string& text) { parse_target(text); })
      .checked_text(
          "distance", settings.distance, "auto or a number above 0",
          "Of the camera from the target, object units; auto: as near as the whole silhouette allows, with 5 % "
          "to spare",
          [](const std::string& text) { parse_distance(text); });
}

}  // namespace kiln
