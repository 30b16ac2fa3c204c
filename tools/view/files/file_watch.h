// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// Notices that the files of folders changed: their names, sizes and times of modification. Folders within them are not
/// looked into, so that what a stage writes before it is whole does not count.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::filesystem::path> folders);

  /// Whether they are not as they were at construction or when this last returned true, and have been left alone since
  /// the call before: a folder that is being copied is not read half way.
  bool changed();

 private:
  std::string stamp() const;

  std::vector<std::filesystem::path> folders_;
  std::string known_, seen_;
};

}  // namespace kiln
