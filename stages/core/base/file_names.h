#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace kiln {

/// Whether the bytes are UTF-8: no overlong form, no surrogate, nothing above U+10FFFF.
bool is_utf8(std::string_view bytes);

/// Bytes of the character that begins at `at` of `bytes`, 1 to 4; 0 where it is no UTF-8.
std::size_t utf8_bytes_at(std::string_view bytes, std::size_t at);

/// A path as text that JSON can hold, which has no bytes but UTF-8: a path that is UTF-8 stands as it is; of others,
/// and of those that contain "\x", bytes that are no UTF-8 and every backslash are written \xNN.
std::string text_of_path(const std::filesystem::path& path);

/// The path that text_of_path made `text` of.
std::filesystem::path path_of_text(std::string_view text);

}  // namespace kiln
