// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kiln {

/// Hashes parts of memory one after another: XXH3 (128 bits), in hexadecimal.
std::string hash_bytes(const std::vector<std::span<const std::byte>>& parts);

/// Hashes a file's bytes: XXH3 (128 bits), in hexadecimal. Throws BadInput.
std::string hash_file(const std::filesystem::path& file);

}  // namespace kiln
