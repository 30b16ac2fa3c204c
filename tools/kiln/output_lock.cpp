// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/output_lock.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int poll_milliseconds = 50;

/// Names the holder as it wrote itself into the lock: "process 123".
std::string holder(int descriptor) {
  char text[64] = {};
  const ssize_t count = pread(descriptor, text, sizeof text - 1, 0);
  const std::string words(text, count > 0 ? static_cast<std::size_t>(count) : 0);
  return words.empty() ? "" : " (" + words.substr(0, words.find('\n')) + ")";
}

/// Tests whether this lock file still stands in the folder: `kiln clean` removes it.
bool is_current(int descriptor, const fs::path& file) {
  struct stat ours = {}, theirs = {};
  return fstat(descriptor, &ours) == 0 && stat(file.c_str(), &theirs) == 0 && ours.st_ino == theirs.st_ino &&
         ours.st_dev == theirs.st_dev;
}

}  // namespace

OutputLock::OutputLock(const fs::path& output) {
  const fs::path folder = output / ".kiln", file = folder / "lock";
  for (bool said = false;;) {
    std::error_code error;
    fs::create_directories(folder, error);
    if (error) fail_to_write(folder, error.message(), error.value());
    descriptor_ = open(file.c_str(), O_RDWR | O_CREAT, 0666);
    if (descriptor_ < 0) fail_to_write(file, std::strerror(errno), errno);
    while (flock(descriptor_, LOCK_EX | LOCK_NB) != 0) {
      if (errno != EWOULDBLOCK && errno != EINTR) fail_to_write(file, std::strerror(errno), errno);
      if (!said)
        std::fprintf(stderr, "kiln: another build is at work in %s%s; waiting for its end\n",
                     output.lexically_normal().c_str(), holder(descriptor_).c_str());
      said = true;
      throw_if_interrupted();
      poll(nullptr, 0, poll_milliseconds);
    }
    if (is_current(descriptor_, file)) break;
    close(descriptor_);
  }
  const std::string text = "process " + std::to_string(getpid()) + "\n";
  if (ftruncate(descriptor_, 0) != 0 || pwrite(descriptor_, text.data(), text.size(), 0) < 0)
    fail_to_write(file, std::strerror(errno), errno);
}

OutputLock::~OutputLock() {
  // Clears the holder's name, so that a build that had nothing to do leaves the folder as it was.
  [[maybe_unused]] const int failure = ftruncate(descriptor_, 0);
  close(descriptor_);
}

}  // namespace kiln
