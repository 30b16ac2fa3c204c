// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace kiln {

/// Writes a pipeline file of these meshes, with comments that say what may be changed. Makes its folder if need be.
/// Throws BadInput where the file is there already, and for a mesh that is not, is none or is given twice.
void init_pipeline(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& file);

/// Text as YAML reads it back: plain where that may be, else between double quotes.
std::string yaml_quoted(const std::string& text);

}  // namespace kiln
