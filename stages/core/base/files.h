// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

namespace kiln {

/// Returns the folder that holds `file`: "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Throws DiskFull where the disk of `path` is full, else BadInput: the file or folder cannot be written. `reason` may
/// be empty; `error_number` is errno, 0 where unknown.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& reason, int error_number = 0);

/// Tells whether the disk of a file or folder, which need not exist, has less free space than any file of Kiln takes.
bool disk_is_full(const std::filesystem::path& path);

/// Returns the whole content of a file. Throws BadInput.
std::string read_text(const std::filesystem::path& file);

}  // namespace kiln
