// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace kiln {

/// Exclusive right of a process, and of the processes that it starts, to write into an output folder. The system
/// releases it when the last of them ends, however that happens.
class OutputLock {
 public:
  /// Takes the lock; makes the folder's .kiln/ if need be. If another build is at work there, says so and waits for its
  /// end. Throws BadInput if the folder cannot be written, Interrupted if asked to stop.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  int descriptor_ = -1;  // inherited by make and the stages, which may outlive a killed driver
};

}  // namespace kiln
