// SPDX-License-Identifier: MIT
#include "base/file_names.h"

#include <cstdint>

namespace kiln {

namespace {

int digit_of(char c) {
  if (c >= '0' && c <= '9') return c - '0';
  return c >= 'a' && c <= 'f' ? c - 'a' + 10 : -1;
}

}  // namespace

std::size_t utf8_bytes_at(std::string_view bytes, std::size_t at) {
  const auto byte = [&](std::size_t k) { return static_cast<std::uint32_t>(static_cast<unsigned char>(bytes[k])); };
  const std::uint32_t first = byte(at);
  if (first < 0x80) return 1;
  const std::size_t count = first >= 0xf0 && first < 0xf8   ? 4
                            : first >= 0xe0 && first < 0xf0 ? 3
                            : first >= 0xc2 && first < 0xe0 ? 2
                                                            : 0;
  if (count == 0 || at + count > bytes.size()) return 0;
  std::uint32_t code = first & (0xffu >> (count + 1));
  for (std::size_t k = 1; k < count; ++k) {
    if ((byte(at + k) & 0xc0u) != 0x80u) return 0;
    code = code << 6 | (byte(at + k) & 0x3fu);
  }
  const bool overlong = (count == 3 && code < 0x800) || (count == 4 && code < 0x10000);
  const bool surrogate = code >= 0xd800 && code < 0xe000;
  return overlong || surrogate || code > 0x10ffff ? 0 : count;
}

bool is_utf8(std::string_view bytes) {
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t count = utf8_bytes_at(bytes, at);
    if (count == 0) return false;
    at += count;
  }
  return true;
}

std::string text_of_path(const std::filesystem::path& path) {
  const std::string& bytes = path.native();
  if (is_utf8(bytes) && bytes.find("\\x") == std::string::npos) return bytes;
  std::string text;
  for (std::size_t at = 0; at < bytes.size();) {
    const std::size_t count = utf8_bytes_at(bytes, at);
    if (count > 0 && bytes[at] != '\\') {
      text.append(bytes, at, count);
      at += count;
      continue;
    }
    constexpr char digits[] = "0123456789abcdef";
    const auto byte = static_cast<unsigned char>(bytes[at++]);
    text += {'\\', 'x', digits[byte >> 4], digits[byte & 15]};
  }
  return text;
}

std::filesystem::path path_of_text(std::string_view text) {
  std::string bytes;
  for (std::size_t at = 0; at < text.size(); ++at) {
    const bool escaped = text[at] == '\\' && at + 3 < text.size() && text[at + 1] == 'x' &&
                         digit_of(text[at + 2]) >= 0 && digit_of(text[at + 3]) >= 0;
    bytes += escaped ? static_cast<char>(digit_of(text[at + 2]) * 16 + digit_of(text[at + 3])) : text[at];
    if (escaped) at += 3;
  }
  return bytes;
}

}  // namespace kiln
