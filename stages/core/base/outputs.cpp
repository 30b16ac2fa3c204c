// SPDX-License-Identifier: MIT
#include "base/outputs.h"

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <system_error>

#include "base/files.h"

namespace kiln {

namespace fs = std::filesystem;

OutputSet::OutputSet(fs::path folder) : folder_(std::move(folder)) {
  make_folder(folder_);
  std::error_code error;
  if (!fs::is_directory(folder_, error)) fail_to_write(folder_, "it is not a folder");
  std::string pattern = (folder_ / ".kiln-XXXXXX").string();
  if (mkdtemp(pattern.data()) == nullptr) fail_to_write(folder_, std::strerror(errno), errno);
  staging_ = pattern;
}

OutputSet::~OutputSet() {
  std::error_code ignored;
  fs::remove_all(staging_, ignored);
  if (!committed_)
    for (const fs::path& made : made_folders_) fs::remove(made, ignored);  // only where empty
}

void OutputSet::make_folder(const fs::path& folder) {
  std::error_code error;
  std::vector<fs::path> missing;
  for (fs::path part = fs::absolute(folder).lexically_normal(); !part.empty() && !fs::exists(part, error);
       part = part.parent_path())
    missing.push_back(part);
  made_folders_.insert(made_folders_.begin(), missing.begin(), missing.end());  // the innermost first
  if (!fs::is_directory(folder, error)) fs::create_directories(folder, error);
  if (error) fail_to_write(folder, error.message(), error.value());
}

fs::path OutputSet::add(const std::string& name) {
  names_.push_back(name);
  const fs::path staged = staging_ / name;
  std::error_code error;
  if (staged.parent_path() != staging_) fs::create_directories(staged.parent_path(), error);
  if (error) fail_to_write(folder_ / name, error.message(), error.value());
  return staged;
}

void OutputSet::add_text(const std::string& name, const std::string& text) {
  errno = 0;
  std::ofstream stream(add(name), std::ios::binary);
  stream << text;
  stream.close();
  if (!stream) fail_to_write(folder_ / name, std::strerror(errno), errno);
}

void OutputSet::remove_stale(const std::string& name) { stale_.push_back(name); }

void OutputSet::commit() {
  if (disk_is_full(staging_)) fail_to_write(folder_ / (names_.empty() ? "" : names_.back()), "", ENOSPC);
  std::error_code error;
  for (const std::string& name : names_)
    if (fs::is_directory(folder_ / name, error)) fail_to_write(folder_ / name, "it is a folder");
  for (const std::string& name : names_)
    if (const fs::path folder = (folder_ / name).parent_path(); folder != folder_) make_folder(folder);
  for (const std::string& name : names_) {
    fs::rename(staging_ / name, folder_ / name, error);
    if (error) fail_to_write(folder_ / name, error.message(), error.value());
  }
  for (const std::string& name : stale_) fs::remove(folder_ / name, error);
  committed_ = true;
}

}  // namespace kiln
