// SPDX-License-Identifier: GPL-3.0-or-later
#include "lod/lod_settings.h"

#include <algorithm>

#include "base/errors.h"
#include "base/numbers.h"

namespace kiln {

namespace {

constexpr std::size_t most_levels_asked = 16;

/// Reads numbers between commas or semicolons, with or without blanks.
std::vector<double> parse_list(const std::string& name, std::string text, double lowest, double highest) {
  std::replace(text.begin(), text.end(), ';', ',');
  std::erase(text, ' ');
  std::vector<double> numbers = parse_numbers(name, text, lowest, highest);
  if (numbers.size() > most_levels_asked)
    throw WrongUsage(name + ": found " + std::to_string(numbers.size()) + " of them; expected " +
                     std::to_string(most_levels_asked) + " at most");
  return numbers;
}

void check_shares(const std::string& text) {
  const std::vector<double> shares = parse_list("levels", text, 1e-6, 1);
  if (std::adjacent_find(shares.begin(), shares.end(), std::less_equal<>()) != shares.end())
    throw WrongUsage("levels: found '" + text + "'; expected each smaller than the one before");
  if (shares == std::vector<double>{1})
    throw WrongUsage("levels: found '" + text + "', which is the atlas mesh itself; expected a share below 1");
}

void check_pixels(const std::string& text) {
  const std::vector<double> errors = parse_list("pixels", text, 1e-3, 1e6);
  if (std::adjacent_find(errors.begin(), errors.end(), std::greater_equal<>()) != errors.end())
    throw WrongUsage("pixels: found '" + text + "'; expected each larger than the one before");
}

}  // namespace

std::vector<double> LodSettings::shares() const {
  std::vector<double> all = parse_list("levels", levels, 1e-6, 1);
  std::erase(all, 1.0);
  return all;
}

std::vector<double> LodSettings::pixel_errors() const {
  return pixels.empty() ? std::vector<double>() : parse_list("pixels", pixels, 1e-3, 1e6);
}

OptionSet lod_options(LodSettings& settings) {
  OptionSet options;
  options
      .checked_text("levels", settings.levels, "numbers above 0 up to 1, falling, between commas",
                    "Shares of the atlas mesh's triangles that the levels have; 1 stands for that mesh itself",
                    check_shares)
      .checked_text("pixels", settings.pixels, "numbers above 0, rising, between commas",
                    "In place of --levels: errors, in pixels of a picture of --lines that the asset fills, each for a "
                    "level as coarse as keeps to it",
                    check_pixels)
      .number("switch-pixels", settings.switch_pixels, 0.01, 1000,
              "Error, pixels, that a level shows at the distance which is proposed for it")
      .integer("lines", settings.view.lines, 16, 65536, "Lines of the picture that pixels are of")
      .number("fov", settings.view.vertical_fov_degrees, 1, 170,
              "Vertical field of view of the camera that distances are for, degrees")
      .number_or_auto("overhang", settings.overhang_texels, 0, 64,
                      "Texels that a chart of a level may hang over its outline, and twice as many and half of one "
                      "where they are nearer to it than to any other chart; auto: half of the atlas's smallest gap "
                      "less half a texel, which bilinear lookups take")
      .extent("size", settings.size, 0, 16384, "Size of the atlas, texels; 0: as atlas.json beside it says");
  return options;
}

}  // namespace kiln
