// SPDX-License-Identifier: GPL-3.0-or-later
#include "probes/probes_settings.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sstream>
#include <vector>

#include "base/errors.h"

namespace kiln {

namespace {

constexpr int most_along_axis = 1024;

/// Parses the whole text as one number; none where it is not.
template <class Number>
std::optional<Number> number_of(const std::string& text) {
  Number value{};
  const char* end = text.data() + text.size();
  const auto [rest, fault] = std::from_chars(text.data(), end, value);
  if (fault != std::errc() || rest != end) return std::nullopt;
  return value;
}

/// Parses the numbers between separators; none where one is not a number.
template <class Number>
std::vector<Number> numbers_of(const std::string& text, char separator) {
  std::vector<Number> numbers;
  std::istringstream stream(text + separator);
  for (std::string part; std::getline(stream, part, separator);) {
    const std::optional<Number> number = number_of<Number>(part);
    if (!number) return {};
    numbers.push_back(*number);
  }
  return numbers;
}

std::string grid_text(const std::array<int, 3>& grid) { return fmt::format("{}", fmt::join(grid, "x")); }

std::string box_text(const std::optional<ProbeBox>& box) {
  return box ? fmt::format("{}", fmt::join(*box, ",")) : "auto";
}

}  // namespace

std::array<int, 3> parse_grid(const std::string& text) {
  const std::vector<int> numbers = numbers_of<int>(text, 'x');
  const bool good = numbers.size() == 3 && std::all_of(numbers.begin(), numbers.end(), [](int points) {
                      return points >= 1 && points <= most_along_axis;
                    });
  if (!good || static_cast<std::size_t>(numbers[0]) * numbers[1] * numbers[2] > most_grid_points)
    throw WrongUsage("grid: found '" + text + "'; expected NxMxK, each 1 to " + std::to_string(most_along_axis) +
                     ", at most " + std::to_string(most_grid_points) + " points in all");
  return {numbers[0], numbers[1], numbers[2]};
}

std::optional<ProbeBox> parse_box(const std::string& text) {
  if (text == "auto") return std::nullopt;
  std::string plain;  // a list of pipeline.yaml comes with "; " between its items
  for (const char c : text)
    if (c != ' ') plain += c == ';' ? ',' : c;
  const std::vector<float> numbers = numbers_of<float>(plain, ',');
  bool good = numbers.size() == 6;
  for (std::size_t k = 0; good && k < 6; ++k)
    good = std::abs(numbers[k]) <= farthest_probe && (k < 3 || numbers[k - 3] <= numbers[k]);
  if (!good)
    throw WrongUsage(
        "box: found '" + text +
        "'; expected auto, or six numbers X0,Y0,Z0,X1,Y1,Z1, -1e+12 to 1e+12, none of the first three above its "
        "second");
  ProbeBox box{};
  std::copy(numbers.begin(), numbers.end(), box.begin());
  return box;
}

OptionSet probes_options(ProbesSettings& settings) {
  OptionSet options;
  options
      .typed<std::array<int, 3>>("grid", settings.grid, "NxMxK, each 1 to 1024",
                                 "Points along x, y and z, at the box's borders and evenly between", parse_grid,
                                 grid_text)
      .typed<std::optional<ProbeBox>>(
          "box", settings.box, "auto or X0,Y0,Z0,X1,Y1,Z1",
          "The grid's box, object units; auto: that of the meshes and half its longest side around", parse_box,
          box_text)
      .integer("bands", settings.bands, 1, 8, "Bands of spherical harmonics: a matrix has bands^4 entries")
      .integer("directions", settings.directions, 16, 65536, "Directions that a point looks into")
      .choice("sampling", settings.sampling, {{"fibonacci", Sampling::fibonacci}, {"stratified", Sampling::stratified}},
              "How the directions are spread");
  add_bounces_option(
      options, settings.bounces,
      "How often light bounces off the meshes on its way to a point; auto: until a bounce adds less than "
      "a thousandth")
      .number("bounce-edge", settings.bounce_edge, 1e-4, 1,
              "Longest edge of the triangles that light bounces off, a fraction of the meshes' diagonal");
  add_material_options(options, settings.material);
  add_import_options(options, settings.import);
  return options;
}

}  // namespace kiln
