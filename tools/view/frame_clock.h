// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <chrono>
#include <deque>
#include <numeric>

namespace kiln {

/// Mean time of the last frames.
class FrameClock {
 public:
  void begin() { begun_ = Clock::now(); }

  /// Ends a frame. The first frame of each kind does not count: it compiles shaders and uploads textures.
  void end() {
    const auto now = Clock::now();
    ++frames_;
    if (is_first_) {
      is_first_ = false;
      return;
    }
    last_.push_back(std::chrono::duration<double, std::milli>(now - begun_).count());
    if (last_.size() > most) last_.pop_front();
    if (steady_ == 0 || now - steady_since_ > reading_time) {
      steady_ = mean_milliseconds();
      steady_since_ = now;
    }
  }

  /// Starts over, for frames of another kind.
  void restart() {
    last_.clear();
    is_first_ = true;
    steady_ = 0;
  }

  /// Returns the mean over up to 30 frames; 0 if there is none.
  double mean_milliseconds() const {
    return last_.empty() ? 0 : std::accumulate(last_.begin(), last_.end(), 0.0) / static_cast<double>(last_.size());
  }

  /// Returns the mean of up to a quarter of a second ago, which changes slowly enough to be read.
  double steady_milliseconds() const { return steady_; }

  /// Returns how many frames the mean covers, and how many there were in all.
  int measured() const { return static_cast<int>(last_.size()); }
  int frames() const { return frames_; }

 private:
  using Clock = std::chrono::steady_clock;
  static constexpr std::size_t most = 30;
  static constexpr std::chrono::milliseconds reading_time{250};
  Clock::time_point begun_, steady_since_;
  std::deque<double> last_;
  double steady_ = 0;
  bool is_first_ = true;
  int frames_ = 0;
};

}  // namespace kiln
