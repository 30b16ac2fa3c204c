// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// Says why a text cannot be the name of an asset, and so of its folder on any system; empty if it can. A name is UTF-8
/// of any script, of at most 200 bytes, without control characters and / \ : * ? " < > |. It does not begin with a dot,
/// hyphen or blank, does not end with a dot, a blank, .yaml or .yml, and is neither Makefile nor index.html, which
/// stand beside the assets' folders.
std::string fault_of_name(const std::string& name);

/// Description of what fault_of_name() accepts, for messages.
inline constexpr const char* what_a_name_is =
    "a name of letters, digits and signs of any script, without / \\ : * ? \" < > | and control characters";

/// Names the asset of a mesh file: the file's name without its extension, with "_" for each character that a name
/// cannot have.
std::string name_of_mesh(const std::filesystem::path& mesh);

/// Tests whether a text has characters that make it a pattern: * ? [ {.
bool is_pattern(const std::string& text);

/// Lists the files that a shell pattern (* ? [a-z] {a,b}) matches, seen from `folder` and relative to it if the pattern
/// is, in the order of their bytes. Names that begin with a dot match only a pattern that does.
std::vector<std::filesystem::path> matching_files(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace kiln
