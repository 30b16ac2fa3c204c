// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "view/state/view_state.h"

namespace kiln {

inline constexpr char escape_key = '\x1b';
/// Arrows, by codes that no key types.
inline constexpr char left_key = '\x11', right_key = '\x12', up_key = '\x13', down_key = '\x14';

/// Wish of a key that does not change the state.
enum class Wish { none, screenshot, close };

struct KeyResult {
  Wish wish = Wish::none;
  std::string message;  ///< for the person: why nothing happened; empty if there is nothing to say
};

/// Carries out a key's action. `home` is the state that `r` returns to. Keys without a meaning do nothing.
KeyResult press(ViewState& state, const ViewLimits& limits, const ViewState& home, char key);

/// Lists the keys and what they do, in the order of the help; then what the pointer does.
std::vector<std::pair<std::string, std::string>> key_help();

/// Formats the key help as lines of text.
std::string key_help_text();

/// Finds a key by its name in scripts and help: one character, or "escape". 0 if there is none of that name.
char key_named(std::string_view name);

}  // namespace kiln
