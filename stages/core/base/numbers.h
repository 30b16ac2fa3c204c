// SPDX-License-Identifier: MIT
#pragma once

// This header has no .cpp file, so that rooms which link nothing may use it.

#include <algorithm>
#include <array>
#include <charconv>
#include <optional>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

#include "base/errors.h"

namespace kiln {

/// Parses numbers between commas, as in "1,0.9,0.8"; all finite and within `lowest` to `highest`. Throws WrongUsage for
/// anything else; its message calls the value `name`.
inline std::vector<double> parse_numbers(std::string_view name, std::string_view text, double lowest, double highest) {
  std::vector<double> numbers;
  for (std::size_t begin = 0;;) {
    const std::size_t comma = std::min(text.find(',', begin), text.size());
    double number = 0;
    const auto [end, fault] = std::from_chars(text.data() + begin, text.data() + comma, number);
    if (fault != std::errc() || end != text.data() + comma || !(number >= lowest && number <= highest)) {
      std::ostringstream message;
      message << name << ": found '" << text << "'; expected numbers between commas, each " << lowest << " to "
              << highest;
      throw WrongUsage(message.str());
    }
    numbers.push_back(number);
    if (comma == text.size()) return numbers;
    begin = comma + 1;
  }
}

/// Parses red, green and blue, each within `lowest` to `highest`: "0.8" (three times that) or "0.8,0.5,0.2", also with
/// the semicolons that a list of pipeline.yaml becomes, and blanks around numbers. Returns nothing for other text.
inline std::optional<std::array<double, 3>> color_within(std::string_view text, double lowest, double highest) {
  std::array<double, 3> color{};
  for (std::size_t count = 0, begin = 0; count < color.size();) {
    std::size_t end = std::min(text.find_first_of(",;", begin), text.size());
    const std::size_t separator = end;
    while (begin < end && text[begin] == ' ') ++begin;
    while (begin < end && text[end - 1] == ' ') --end;
    double& number = color[count++];
    const auto [stop, fault] = std::from_chars(text.data() + begin, text.data() + end, number);
    if (fault != std::errc() || stop != text.data() + end || !(number >= lowest && number <= highest)) break;
    if (separator == text.size()) {
      if (count == 1) color = {number, number, number};
      return count == 2 ? std::nullopt : std::optional(color);
    }
    begin = separator + 1;
  }
  return std::nullopt;
}

/// Parses a colour as color_within does. Throws WrongUsage for other text; its message calls the value `name`.
inline std::array<float, 3> parse_color(std::string_view name, std::string_view text, double lowest, double highest) {
  const std::optional<std::array<double, 3>> color = color_within(text, lowest, highest);
  if (!color) {
    std::ostringstream message;
    message << name << ": found '" << text << "'; expected one number or R,G,B, each " << lowest << " to " << highest;
    throw WrongUsage(message.str());
  }
  const auto& [red, green, blue] = *color;
  return {static_cast<float>(red), static_cast<float>(green), static_cast<float>(blue)};
}

}  // namespace kiln
