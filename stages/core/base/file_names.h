// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kiln {

/// Tells whether bytes are UTF-8: no overlong form, no surrogate, nothing above U+10FFFF.
bool is_utf8(std::string_view bytes);

/// Returns the number of bytes, 1 to 4, of the character that begins at `at`; 0 where it is not UTF-8.
std::size_t utf8_bytes_at(std::string_view bytes, std::size_t at);

/// Writes a path as text that JSON can hold. A path that is UTF-8 is unchanged. In others, and in those that contain
/// "\x", bytes that are not UTF-8 and every backslash are written \xNN.
std::string text_of_path(const std::filesystem::path& path);

/// Returns the path that text_of_path turned into `text`.
std::filesystem::path path_of_text(std::string_view text);

}  // namespace kiln
