// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "kiln/gate/gate.h"

namespace kiln {

/// Names, in a pipeline's output folder, of the page, its data, and the folder of its pictures.
inline constexpr const char* comparison_file = "comparison.html";
inline constexpr const char* comparison_data_file = "comparison.json";
inline constexpr const char* comparison_folder = "comparison";

/// Makes the page of a comparison: for each asset the pictures of the baseline and of this build with their difference,
/// its budgets, and its metrics, those that got worse first. Links are relative.
std::string comparison_html(const Gate& gate);

/// Returns the same as data (docs/schema/comparison.schema.json).
Json to_json(const Gate& gate);

/// Returns a kind of change as comparison.json names it: "worse".
std::string to_string(ChangeKind kind);

}  // namespace kiln
