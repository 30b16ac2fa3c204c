// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <string>

namespace kiln {

/// Progress bar with the time left, on stderr where that is a terminal, else nothing. Throws Interrupted once the
/// process was asked to stop (stop_on_signals).
class ProgressBar {
 public:
  ProgressBar(std::string label, bool quiet);
  ~ProgressBar();
  ProgressBar(const ProgressBar&) = delete;
  ProgressBar& operator=(const ProgressBar&) = delete;

  void operator()(double fraction);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool shown_;
  bool drawn_ = false;
  Clock::time_point start_;
  Clock::time_point drawn_at_;
};

}  // namespace kiln
