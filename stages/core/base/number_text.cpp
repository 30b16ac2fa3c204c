// SPDX-License-Identifier: MIT
#include "base/number_text.h"

#include <fmt/format.h>

namespace kiln {

std::string numbers_text(std::initializer_list<double> numbers) {
  std::string text;
  for (const double number : numbers) text += (text.empty() ? "" : ",") + fmt::format("{}", number);
  return text;
}

std::string color_text(const std::array<float, 3>& color) {
  const auto [red, green, blue] = color;
  return red == green && green == blue ? fmt::format("{}", red) : fmt::format("{},{},{}", red, green, blue);
}

}  // namespace kiln
