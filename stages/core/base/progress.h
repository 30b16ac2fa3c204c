// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstddef>
#include <functional>
#include <string>

namespace kiln {

/// Callback that receives the fraction done, 0 to 1, on the calling thread. May throw Interrupted, which a stage lets
/// through.
using ProgressFunction = std::function<void(double fraction)>;

inline void no_progress(double) {}

/// Returns the progress of a part of a task: the part's 0 to 1 are the task's `from` to `to`.
inline ProgressFunction part_of(const ProgressFunction& progress, double from, double to) {
  return [progress, from, to](double fraction) { progress(from + (to - from) * fraction); };
}

/// Returns the progress of step `index`, from 0, of `count` equal steps of a task.
inline ProgressFunction step_of(const ProgressFunction& progress, std::size_t index, std::size_t count) {
  const auto all = static_cast<double>(count);
  return part_of(progress, static_cast<double>(index) / all, static_cast<double>(index + 1) / all);
}

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

/// Makes SIGINT and SIGTERM be noted instead of ending the process; see throw_if_interrupted.
void stop_on_signals();

/// Throws Interrupted if a signal was noted.
void throw_if_interrupted();

/// Returns the signal that was noted, 0 for none.
int noted_signal();

}  // namespace kiln
