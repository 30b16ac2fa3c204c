// SPDX-License-Identifier: MIT
#include "sh/light_spec.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "base/errors.h"
#include "base/numbers.h"
#include "sh/directions.h"

namespace kiln {

namespace {

constexpr double brightest = 1e6;

/// Writes the shortest text that from_chars reads as the same number.
template <class Number>
std::string shortest(Number value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

[[noreturn]] void fail(std::string_view name, std::string_view found, const std::string& expected) {
  throw WrongUsage(std::string(name) + ": found '" + std::string(found) + "'; expected " + expected);
}

/// Syntax of a kind of light: its name, and how many numbers come before the colour.
struct Syntax {
  LightSpec::Kind kind;
  std::string_view name;
  std::size_t numbers;
  std::string_view form;
};
constexpr std::array<Syntax, 5> syntaxes = {
    {{LightSpec::Kind::directional, "directional", 2, "AZIMUTH,ELEVATION[,R,G,B]"},
     {LightSpec::Kind::cone, "cone", 3, "cone:AZIMUTH,ELEVATION,HALF-ANGLE[,R,G,B]"},
     {LightSpec::Kind::sphere, "sphere", 4, "sphere:X,Y,Z,RADIUS[,R,G,B]"},
     {LightSpec::Kind::hemisphere, "hemisphere", 2, "hemisphere:AZIMUTH,ELEVATION,R,G,B,R,G,B"},
     {LightSpec::Kind::ambient, "ambient", 0, "ambient:RADIANCE or ambient:R,G,B"}}};

const Syntax& syntax_of(LightSpec::Kind kind) {
  return *std::find_if(syntaxes.begin(), syntaxes.end(), [&](const Syntax& syntax) { return syntax.kind == kind; });
}

/// Reads the colour that starts at `first` of a list of numbers.
std::array<float, 3> color_at(const std::vector<double>& values, std::size_t first) {
  std::array<float, 3> color;
  for (std::size_t c = 0; c < 3; ++c) color[c] = static_cast<float>(values[first + c]);
  return color;
}

/// Throws WrongUsage that quotes `found` unless the numbers of a light are in range; NaN is not.
void check(const LightSpec& spec, std::string_view found) {
  const auto require = [&](bool holds, const char* expected) {
    if (!holds) fail("light", found, expected);
  };
  const auto is_within = [](double value, double most) { return std::abs(value) <= most; };
  for (const auto* color : {&spec.color, &spec.ground})
    for (const float value : *color) {
      require(!(value < 0), "a colour of no negative numbers");
      require(is_within(static_cast<double>(value), brightest), "colours of 0 to 1e6");
    }
  if (spec.kind == LightSpec::Kind::sphere) {
    for (const double coordinate : spec.position) require(is_within(coordinate, brightest), "a place within 1e6 units");
    require(spec.radius > 0, "a radius above 0");
    require(is_within(spec.radius, brightest), "a radius of up to 1e6");
    return;
  }
  require(is_within(spec.azimuth_degrees, 360), "an azimuth of -360 to 360 degrees");
  require(is_within(spec.elevation_degrees, 90), "an elevation of -90 to 90 degrees");
  if (spec.kind == LightSpec::Kind::cone)
    require(spec.half_angle_degrees >= 0 && spec.half_angle_degrees <= 180, "a half-angle of 0 to 180 degrees");
}

std::string to_text(const std::array<float, 3>& color) {
  return shortest(color[0]) + "," + shortest(color[1]) + "," + shortest(color[2]);
}

}  // namespace

LightSpec parse_light_spec(std::string_view text) {
  // The kind stands before a colon; a directional light needs no name.
  const std::size_t colon = text.find(':');
  const std::string_view name = colon == text.npos ? "directional" : text.substr(0, colon);
  const std::string_view numbers = colon == text.npos ? text : text.substr(colon + 1);
  const auto syntax =
      std::find_if(syntaxes.begin(), syntaxes.end(), [&](const Syntax& known) { return known.name == name; });
  if (syntax == syntaxes.end()) {
    std::string forms;
    for (const Syntax& known : syntaxes) forms += (forms.empty() ? "" : "; ") + std::string(known.form);
    fail("light", text, "one of " + forms);
  }
  LightSpec spec;
  spec.kind = syntax->kind;
  if (spec.kind == LightSpec::Kind::ambient) {
    spec.color = parse_color("light", numbers, 0, brightest);
    return spec;
  }

  const std::vector<double> values = parse_numbers("light", numbers, -brightest, brightest);
  const std::size_t colors = spec.kind == LightSpec::Kind::hemisphere ? 2 : 1;
  const bool has_colors = values.size() == syntax->numbers + 3 * colors;
  if (!has_colors && (colors == 2 || values.size() != syntax->numbers)) fail("light", text, std::string(syntax->form));
  if (has_colors) spec.color = color_at(values, syntax->numbers);
  if (colors == 2) spec.ground = color_at(values, syntax->numbers + 3);
  if (spec.kind == LightSpec::Kind::sphere) {
    spec.position = {values[0], values[1], values[2]};
    spec.radius = values[3];
  } else {
    spec.azimuth_degrees = values[0];
    spec.elevation_degrees = values[1];
    if (spec.kind == LightSpec::Kind::cone) spec.half_angle_degrees = values[2];
  }
  check(spec, text);
  return spec;
}

void check_light_spec(const LightSpec& spec) { check(spec, to_text(spec)); }

std::string to_text(const LightSpec& spec) {
  const std::string name(syntax_of(spec.kind).name),
      angles = shortest(spec.azimuth_degrees) + "," + shortest(spec.elevation_degrees);
  switch (spec.kind) {
    case LightSpec::Kind::directional:
      return name + ":" + angles + "," + to_text(spec.color);
    case LightSpec::Kind::cone:
      return name + ":" + angles + "," + shortest(spec.half_angle_degrees) + "," + to_text(spec.color);
    case LightSpec::Kind::sphere:
      return name + ":" + shortest(spec.position[0]) + "," + shortest(spec.position[1]) + "," +
             shortest(spec.position[2]) + "," + shortest(spec.radius) + "," + to_text(spec.color);
    case LightSpec::Kind::hemisphere:
      return name + ":" + angles + "," + to_text(spec.color) + "," + to_text(spec.ground);
    case LightSpec::Kind::ambient:
      break;
  }
  return name + ":" + to_text(spec.color);
}

namespace {

/// Returns the sine of half the angle that a ball covers as seen from `distance`; 1 from inside.
double sine_of_ball(double radius, double distance) { return distance > radius ? radius / distance : 1; }

}  // namespace

LightCoefficients light_coefficients(const LightSpec& spec, int bands, const Eigen::Vector3d& viewpoint) {
  const Eigen::Vector3f direction = direction_from_angles(spec.azimuth_degrees, spec.elevation_degrees);
  switch (spec.kind) {
    case LightSpec::Kind::directional:
      return directional_light(bands, direction, spec.color);
    case LightSpec::Kind::cone:
      return cone_light(bands, direction, spec.half_angle_degrees * std::numbers::pi / 180, spec.color);
    case LightSpec::Kind::sphere: {
      const Eigen::Vector3d position(spec.position.data()), away = position - viewpoint;
      const double ratio = sine_of_ball(spec.radius, away.norm()) / sine_of_ball(spec.radius, position.norm());
      return scale_light(sphere_light(bands, away.cast<float>(), spec.radius, spec.color), ratio * ratio);
    }
    case LightSpec::Kind::hemisphere:
      return hemisphere_light(bands, direction, spec.color, spec.ground);
    case LightSpec::Kind::ambient:
      break;
  }
  return constant_light(bands, spec.color);
}

std::vector<double> window_weights(const LightSpec& spec, int bands, LightWindow window,
                                   const Eigen::Vector3d& viewpoint) {
  const std::vector<double> as_it_is(static_cast<std::size_t>(bands), 1.0);
  switch (spec.kind) {
    case LightSpec::Kind::directional:
      return axial_weights(cone_bands(bands, 0), window, 1);
    case LightSpec::Kind::cone:
      return axial_weights(cone_bands(bands, spec.half_angle_degrees * std::numbers::pi / 180), window, 1);
    case LightSpec::Kind::sphere: {
      const double distance = (Eigen::Vector3d(spec.position.data()) - viewpoint).norm();
      if (distance <= spec.radius) return as_it_is;
      return axial_weights(cone_bands(bands, std::asin(spec.radius / distance)), window, 1);
    }
    case LightSpec::Kind::hemisphere:
    case LightSpec::Kind::ambient:
      break;
  }
  return as_it_is;
}

LightCoefficients windowed_light(const LightSpec& spec, int bands, LightWindow window,
                                 const Eigen::Vector3d& viewpoint) {
  LightCoefficients light = light_coefficients(spec, bands, viewpoint);
  apply_window(light, window_weights(spec, bands, window, viewpoint));
  return light;
}

LightCoefficients light_coefficients(std::span<const LightSpec> specs, int bands, LightWindow window) {
  LightCoefficients sum = constant_light(bands, std::array<float, 3>{0, 0, 0});
  for (const LightSpec& spec : specs) sum = add_lights(sum, windowed_light(spec, bands, window));
  return sum;
}

}  // namespace kiln
