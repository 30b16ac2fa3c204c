// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

namespace kiln {

/// Writes `member` of a tar file to `mesh`. Throws BadInput if there is no such member.
void extract_member(const std::filesystem::path& archive, const std::string& member, const std::filesystem::path& mesh);

/// Tests whether a tar file has exactly that member.
bool has_member(const std::filesystem::path& archive, const std::string& member);

/// Writes a square about the origin of the xz plane, facing +Y, as an OBJ file with texture coordinates.
void write_square(double half_size, const std::filesystem::path& mesh);

}  // namespace kiln
