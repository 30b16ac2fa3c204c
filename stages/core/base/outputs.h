// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

namespace kiln {

/// Files that one run of a stage writes into one folder. They are written under a temporary folder inside that folder
/// and renamed to their final names together, by commit(); a run that ends before leaves nothing behind.
class OutputSet {
 public:
  /// Makes `folder` (and its parents) if needed. Throws BadInput where it cannot be written.
  explicit OutputSet(std::filesystem::path folder);
  ~OutputSet();
  OutputSet(const OutputSet&) = delete;
  OutputSet& operator=(const OutputSet&) = delete;

  /// Returns the temporary path of the file that will be `folder/name`. Files become visible in the order they were
  /// added, so add the one that describes the others last.
  std::filesystem::path add(const std::string& name);

  /// Writes a text file.
  void add_text(const std::string& name, const std::string& text);

  /// Marks `folder/name`, left by an earlier run and not written by this one, for removal by commit().
  void remove_stale(const std::string& name);

  /// Renames all files to their final names. Throws BadInput where that is not possible, and DiskFull where the disk is
  /// full: the last bytes of a file may be missing then.
  void commit();

  const std::filesystem::path& folder() const { return folder_; }

  /// Returns the names of the files so far, in the order they were added.
  const std::vector<std::string>& names() const { return names_; }

  /// Returns the folder of the files until commit(), for measuring what was written.
  const std::filesystem::path& staging() const { return staging_; }

 private:
  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_folders_;
  std::vector<std::string> names_;
  std::vector<std::string> stale_;
  bool committed_ = false;
};

/// Returns the folder that holds `file`: "." for a bare name.
std::filesystem::path folder_of(const std::filesystem::path& file);

/// Throws DiskFull where the disk of `path` is full, else BadInput: the file or folder cannot be written. `reason` may
/// be empty; `error_number` is errno, 0 where unknown.
[[noreturn]] void fail_to_write(const std::filesystem::path& path, const std::string& reason, int error_number = 0);

/// Tells whether the disk of a file or folder, which need not exist, has less free space than any file of Kiln takes.
bool disk_is_full(const std::filesystem::path& path);

/// Returns the whole content of a file. Throws BadInput.
std::string read_text(const std::filesystem::path& file);

/// Hashes parts of memory one after another: XXH3 (128 bits), in hexadecimal.
std::string hash_bytes(const std::vector<std::span<const std::byte>>& parts);

/// Hashes a file's bytes: XXH3 (128 bits), in hexadecimal. Throws BadInput.
std::string hash_file(const std::filesystem::path& file);

}  // namespace kiln
