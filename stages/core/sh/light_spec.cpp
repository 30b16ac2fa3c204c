#include "sh/light_spec.h"

#include <algorithm>
#include <cassert>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>

#include "base/errors.h"
#include "sh/basis.h"
#include "sh/directions.h"

namespace kiln {

namespace {

constexpr double brightest = 1e6;

std::optional<double> parse_number(std::string_view text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

/// The shortest text that from_chars reads as the same number.
template <class Number>
std::string shortest(Number value) {
  char text[32];
  return std::string(text, std::to_chars(text, text + sizeof text, value).ptr);
}

[[noreturn]] void fail(std::string_view name, std::string_view found, const std::string& expected) {
  throw WrongUsage(std::string(name) + ": found '" + std::string(found) + "'; expected " + expected);
}

}  // namespace

std::vector<double> parse_numbers(std::string_view name, std::string_view text, double lowest, double highest) {
  std::vector<double> numbers;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    const std::optional<double> number = parse_number(text.substr(begin, comma - begin));
    if (!number || *number < lowest || *number > highest) {
      std::ostringstream expected;
      expected << "numbers between commas, each " << lowest << " to " << highest;
      fail(name, text, expected.str());
    }
    numbers.push_back(*number);
    if (comma == text.size()) return numbers;
    begin = comma + 1;
  }
}

std::array<float, 3> parse_colour(std::string_view name, std::string_view text, double lowest, double highest) {
  const std::vector<double> numbers = parse_numbers(name, text, lowest, highest);
  if (numbers.size() != 1 && numbers.size() != 3) fail(name, text, "one number, or three: R,G,B");
  const auto number = [&](std::size_t i) { return static_cast<float>(numbers[numbers.size() == 1 ? 0 : i]); };
  return {number(0), number(1), number(2)};
}

LightSpec parse_light_spec(std::string_view text) {
  constexpr std::string_view directional = "directional:", ambient = "ambient:";
  LightSpec spec;
  if (text.starts_with(ambient)) {
    spec.kind = LightSpec::Kind::ambient;
    spec.colour = parse_colour("light", text.substr(ambient.size()), 0, brightest);
    return spec;
  }
  const std::string_view numbers = text.starts_with(directional) ? text.substr(directional.size()) : text;
  const std::vector<double> values = parse_numbers("light", numbers, -brightest, brightest);
  if (values.size() != 2 && values.size() != 5)
    fail("light", text, "AZIMUTH,ELEVATION or AZIMUTH,ELEVATION,R,G,B or ambient:RADIANCE");
  spec.azimuth_degrees = values[0];
  spec.elevation_degrees = values[1];
  if (std::abs(spec.azimuth_degrees) > 360) fail("light", text, "an azimuth of -360 to 360 degrees");
  if (std::abs(spec.elevation_degrees) > 90) fail("light", text, "an elevation of -90 to 90 degrees");
  for (std::size_t c = 0; c + 2 < values.size(); ++c) {
    if (values[c + 2] < 0) fail("light", text, "a colour of no negative numbers");
    spec.colour[c] = static_cast<float>(values[c + 2]);
  }
  return spec;
}

std::string to_text(const LightSpec& spec) {
  const std::string colour = shortest(spec.colour[0]) + "," + shortest(spec.colour[1]) + "," + shortest(spec.colour[2]);
  if (spec.kind == LightSpec::Kind::ambient) return "ambient:" + colour;
  return "directional:" + shortest(spec.azimuth_degrees) + "," + shortest(spec.elevation_degrees) + "," + colour;
}

LightCoefficients light_coefficients(const LightSpec& spec, int bands) {
  if (spec.kind == LightSpec::Kind::ambient) return constant_light(bands, spec.colour);
  return directional_light(bands, direction_from_angles(spec.azimuth_degrees, spec.elevation_degrees), spec.colour);
}

LightCoefficients add_lights(const LightCoefficients& a, const LightCoefficients& b) {
  assert(a.bands == b.bands && a.channels.size() == b.channels.size());
  LightCoefficients sum = a;
  for (std::size_t c = 0; c < sum.channels.size(); ++c)
    for (std::size_t i = 0; i < sum.channels[c].size(); ++i) sum.channels[c][i] += b.channels[c][i];
  return sum;
}

LightCoefficients light_coefficients(std::span<const LightSpec> specs, int bands, LightWindow window) {
  LightCoefficients sum = constant_light(bands, std::array<float, 3>{0, 0, 0});
  for (const LightSpec& spec : specs) sum = add_lights(sum, light_coefficients(spec, bands));
  if (window == LightWindow::hann) apply_hann_window(sum);
  return sum;
}

}  // namespace kiln
