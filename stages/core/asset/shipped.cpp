// SPDX-License-Identifier: MIT
#include "asset/shipped.h"

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

ShippedParts parse_shipped_parts(const std::string& text) {
  for (const int bits : {0, 8, 16})
    if (const ShippedParts parts{bits}; text == text_of(parts)) return parts;
  throw WrongUsage(std::string(ship_setting) + ": found '" + text + "'; expected normal=none, normal=8 or normal=16");
}

std::string text_of(const ShippedParts& parts) {
  return "normal=" + (parts.normal_bits == 0 ? "none" : std::to_string(parts.normal_bits));
}

std::uint64_t shipped_bytes(const fs::path& folder) {
  std::uint64_t bytes = 0;
  std::error_code error;
  for (const auto& entry : fs::directory_iterator(folder, error))
    if (entry.is_regular_file(error) && entry.path().stem() != "bake" && entry.path().stem() != "compress")
      bytes += entry.file_size(error);
  return bytes;
}

}  // namespace kiln
