// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// What keeps a text from being the name of an asset, and so of its folder on any system; empty where nothing does. A
/// name is UTF-8 of any script, of at most 200 bytes, without control characters and / \ : * ? " < > |. It begins with
/// no dot, hyphen or blank, ends with no dot or blank and not with .yaml or .yml, and is not one of Makefile and
/// index.html, which stand beside the assets' folders.
std::string fault_of_name(const std::string& name);

/// What name_fault() lets a name be, for messages.
inline constexpr const char* what_a_name_is =
    "a name of letters, digits and signs of any script, without / \\ : * ? \" < > | and control characters";

/// A name for the asset of a mesh file: the file's without what follows its last dot, "_" in place of what a name
/// cannot have.
std::string name_of_mesh(const std::filesystem::path& mesh);

/// Whether a text has characters that make it a pattern: * ? [ {.
bool is_pattern(const std::string& text);

/// The files that a pattern of the shell (* ? [a-z] {a,b}) names, seen from `folder` and relative to it where the
/// pattern is, in order of their bytes; names that begin with a dot only where the pattern does.
std::vector<std::filesystem::path> matching_files(const std::filesystem::path& folder, const std::string& pattern);

}  // namespace kiln
