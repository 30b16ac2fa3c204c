// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <initializer_list>
#include <string>

namespace kiln {

/// Numbers between commas, each as short as it reads back.
std::string numbers_text(std::initializer_list<double> numbers);

/// Red, green and blue as color_within reads them: one number where they are equal.
std::string color_text(const std::array<float, 3>& color);

}  // namespace kiln
