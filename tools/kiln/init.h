// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

namespace kiln {

/// Writes a pipeline file for these meshes, with comments that explain what may be changed. Makes its folder if need
/// be. Throws BadInput if the file exists, and for a mesh that does not exist, is no mesh or is given twice.
void init_pipeline(const std::vector<std::filesystem::path>& meshes, const std::filesystem::path& file);

/// Quotes text so that YAML reads it back: plain if possible, else between double quotes.
std::string yaml_quoted(const std::string& text);

}  // namespace kiln
