#pragma once

#include <chrono>
#include <functional>
#include <string>

namespace kiln {

/// Told the fraction done, 0 to 1, from the calling thread. May throw Interrupted, which a stage lets through.
using ProgressFunction = std::function<void(double fraction)>;

inline void no_progress(double) {}

/// A bar with the time left on stderr where that is a terminal, nothing where it is not; throws Interrupted once
/// the process was asked to stop (stop_on_signals).
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

/// From now on SIGINT and SIGTERM are noted instead of ending the process; see throw_if_interrupted.
void stop_on_signals();

/// Throws Interrupted if a signal was noted.
void throw_if_interrupted();

/// The signal that was noted, 0 for none.
int noted_signal();

}  // namespace kiln
