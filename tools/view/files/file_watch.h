// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// Notices changes of the files in some folders: their names, sizes and times of modification. Does not look into
/// subfolders, so that files which a stage is still writing do not count.
class FileWatch {
 public:
  explicit FileWatch(std::vector<std::filesystem::path> folders);

  /// Tests whether files differ from construction or from the last call that returned true, and have not changed since
  /// the previous call: a folder that is being copied is not read half way.
  bool changed();

 private:
  std::string stamp() const;

  std::vector<std::filesystem::path> folders_;
  std::string known_, seen_;
};

}  // namespace kiln
