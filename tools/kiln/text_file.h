// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace kiln {

/// Leaves a file that holds the text already as it is, with its time.
void write_if_changed(const std::filesystem::path& file, const std::string& text);

}  // namespace kiln
