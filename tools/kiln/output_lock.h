// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

namespace kiln {

/// The right to write into an output folder, of one process and what it runs at a time. The system takes it back when
/// the last of them ends, however that happens.
class OutputLock {
 public:
  /// Makes the folder's .kiln/ if need be. Where another build is at work there, says so and waits for its end. Throws
  /// BadInput where the folder cannot be written, Interrupted when it was asked to stop.
  explicit OutputLock(const std::filesystem::path& output);
  ~OutputLock();
  OutputLock(const OutputLock&) = delete;
  OutputLock& operator=(const OutputLock&) = delete;

 private:
  int descriptor_ = -1;  // inherited by make and the stages, which may outlive a driver that is killed
};

}  // namespace kiln
