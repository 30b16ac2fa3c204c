// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
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

  /// Returns the temporary path of the file that will be `folder/name`, where `name` may have folders in it. Files
  /// become visible in the order they were added, so add the one that describes the others last.
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
  /// Makes a folder and its parents if needed, and notes those that were not there.
  void make_folder(const std::filesystem::path& folder);

  std::filesystem::path folder_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_folders_;
  std::vector<std::string> names_;
  std::vector<std::string> stale_;
  bool committed_ = false;
};

}  // namespace kiln
