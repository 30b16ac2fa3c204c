// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace kiln {

/// Script of the page, as tools/web builds it.
struct PageScript {
  std::string_view path;
  std::string_view bytes;  ///< a module of JavaScript
};

/// Returns the scripts of the page, which are part of the program: one.
std::span<const PageScript> page_scripts();

}  // namespace kiln
