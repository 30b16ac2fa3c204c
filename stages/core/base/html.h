// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace kiln {

/// Escapes the characters that HTML and XML reserve, also for values between either kind of quotes.
std::string html_escaped(std::string_view text);

}  // namespace kiln
