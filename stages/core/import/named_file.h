// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string_view>

namespace kiln {

/// Finds the file that another file in `folder` names, perhaps by another machine's path: as written, with slashes for
/// backslashes, by its last part alone, or so regardless of case (the first such name by order of bytes). Nothing where
/// none of these is a file.
std::optional<std::filesystem::path> find_named_file(const std::filesystem::path& folder, std::string_view name);

}  // namespace kiln
