// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace kiln {

/// Finds the word that takes the fewest changes of a letter to become `word`; empty if half of it would have to change.
std::string nearest_of(const std::string& word, const std::vector<std::string>& words);

}  // namespace kiln
