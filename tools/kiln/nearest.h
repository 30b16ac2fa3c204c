// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace kiln {

/// The word that takes the fewest changes of a letter to become `word`; empty where half of it would have to change.
std::string nearest_of(const std::string& word, const std::vector<std::string>& words);

}  // namespace kiln
