// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/level_comparison.h"

namespace kiln {

/// Makes the page's section on levels of detail; empty where there are none. `scratch` is a file for pictures on their
/// way. HTML.
std::string levels_section(const std::vector<LevelComparison>& levels, const std::filesystem::path& scratch);

}  // namespace kiln
