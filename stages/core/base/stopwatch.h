// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>

namespace kiln {

/// Timer of wall-clock seconds since construction.
class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

/// Returns the peak resident memory of this process.
long long peak_memory_bytes();

}  // namespace kiln
