// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "kiln/gate/gate.h"

namespace kiln {

/// Name of that file in a pipeline's output folder.
inline constexpr const char* summary_file = "summary.md";

/// Most lines that summary_markdown returns.
inline constexpr std::size_t summary_lines = 60;

/// Writes the outcome for a pull request, in GitHub's Markdown: what fails, what got worse, what is near its budget,
/// what got better. Returns nothing where all is well, meaning that nothing fails, no metric got worse and no picture
/// drifted, unless `always`.
std::string summary_markdown(const Gate& gate, bool always);

}  // namespace kiln
