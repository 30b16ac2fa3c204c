// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "view/state/view_state.h"

namespace kiln {

inline constexpr char escape_key = '\x1b';

/// What a key asks for that is no change of state.
enum class Wish { none, screenshot, close };

struct KeyResult {
  Wish wish = Wish::none;
  std::string message;  ///< for the person: why nothing happened; empty: nothing to tell
};

/// Does what the key stands for. `home` is the state that `r` goes back to. Keys without a meaning do nothing.
KeyResult press(ViewState& state, const ViewLimits& limits, const ViewState& home, char key);

/// Keys and what they do, in the order of the help; then what the pointer does.
std::vector<std::pair<std::string, std::string>> key_help();

/// The same as lines of text.
std::string key_help_text();

/// The key of a name as a script and the help have it: one character, or "escape". 0 where there is none of that name.
char key_named(std::string_view name);

}  // namespace kiln
