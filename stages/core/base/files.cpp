// SPDX-License-Identifier: MIT
#include "base/files.h"

#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <sys/statvfs.h>
#include <system_error>
#include <unistd.h>

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

bool disk_is_full(const fs::path& path) {
  constexpr unsigned long long least_bytes = 4096;
  std::error_code error;
  fs::path place = fs::absolute(path, error);
  while (!place.empty() && !fs::exists(place, error) && place != place.parent_path()) place = place.parent_path();
  struct statvfs disk = {};
  if (statvfs(place.c_str(), &disk) != 0 || disk.f_blocks == 0) return false;
  const auto blocks = geteuid() == 0 ? disk.f_bfree : disk.f_bavail;  // some are kept for root
  return static_cast<unsigned long long>(blocks) * disk.f_frsize < least_bytes;
}

void fail_to_write(const fs::path& path, const std::string& reason, int error_number) {
  if (error_number == ENOSPC || error_number == EDQUOT || disk_is_full(path))
    throw DiskFull(path.string() + ": cannot be written, the disk is full; free some room, or choose another output");
  throw BadInput(path.string(), "cannot be written" + (reason.empty() ? "" : " (" + reason + ")"),
                 "a place that can be written", "choose another output or change its permissions");
}

fs::path folder_of(const fs::path& file) {
  const fs::path parent = file.parent_path();
  return parent.empty() ? fs::path(".") : parent;
}

std::string read_text(const fs::path& file) {
  const auto fail = [&](const std::string& found) {
    return BadInput(file.string(), found, "a readable file", "check the path and its permissions");
  };
  if (!fs::exists(file)) throw fail("does not exist");
  if (fs::is_directory(file)) throw fail("is a folder");
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw fail(std::string("cannot be opened (") + std::strerror(errno) + ")");
  std::error_code no_size;  // a pipe has none
  const auto size = fs::file_size(file, no_size);
  std::string text(no_size ? 0 : size, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  text.resize(static_cast<std::size_t>(stream.gcount()));
  if (stream) text.append(std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>());
  if (stream.bad()) throw fail("cannot be read to its end");
  return text;
}

}  // namespace kiln
