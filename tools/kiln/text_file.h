// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace kiln {

/// Writes a file, unless it holds the text already; then it keeps its time.
void write_if_changed(const std::filesystem::path& file, const std::string& text);

}  // namespace kiln
