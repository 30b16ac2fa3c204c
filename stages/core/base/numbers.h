// SPDX-License-Identifier: MIT
#pragma once

// This header has no .cpp file, so that rooms which link nothing may use it.

#include <array>
#include <charconv>
#include <cmath>
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

/// Parses one grey number or R,G,B, as parse_numbers does.
inline std::array<float, 3> parse_color(std::string_view name, std::string_view text, double lowest, double highest) {
  const std::vector<double> numbers = parse_numbers(name, text, lowest, highest);
  if (numbers.size() != 1 && numbers.size() != 3)
    throw WrongUsage(std::string(name) + ": found '" + std::string(text) + "'; expected one number, or three: R,G,B");
  const auto number = [&](std::size_t i) { return static_cast<float>(numbers[numbers.size() == 1 ? 0 : i]); };
  return {number(0), number(1), number(2)};
}

}  // namespace kiln
