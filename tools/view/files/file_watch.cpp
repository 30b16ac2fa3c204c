// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/files/file_watch.h"

#include <algorithm>
#include <utility>

namespace kiln {

namespace fs = std::filesystem;

FileWatch::FileWatch(std::vector<fs::path> folders) : folders_(std::move(folders)), known_(stamp()), seen_(known_) {}

bool FileWatch::changed() {
  std::string now = stamp();
  const bool settled = now == seen_;
  seen_ = std::move(now);
  if (!settled || seen_ == known_) return false;
  known_ = seen_;
  return true;
}

std::string FileWatch::stamp() const {
  std::string stamp;
  for (const fs::path& folder : folders_) {
    std::vector<std::string> files;
    std::error_code error;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error)) {
      std::error_code gone;  // removed between being listed and being examined
      if (!entry->is_regular_file(gone)) continue;
      const auto time = entry->last_write_time(gone).time_since_epoch().count();
      files.push_back(entry->path().filename().string() + "/" + std::to_string(entry->file_size(gone)) + "/" +
                      std::to_string(time) + "\n");
    }
    std::sort(files.begin(), files.end());
    for (const std::string& file : files) stamp += file;
    stamp += "\n";
  }
  return stamp;
}

}  // namespace kiln
