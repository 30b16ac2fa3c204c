// SPDX-License-Identifier: MIT
#include "base/progress_bar.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <unistd.h>

#include "base/interruption.h"

namespace kiln {

ProgressBar::ProgressBar(std::string label, bool quiet)
    : label_(std::move(label)), shown_(!quiet && isatty(STDERR_FILENO) != 0), start_(Clock::now()), drawn_at_(start_) {}

ProgressBar::~ProgressBar() {
  if (drawn_) std::fputs("\r\x1b[K", stderr);
}

void ProgressBar::operator()(double fraction) {
  throw_if_interrupted();
  const Clock::time_point now = Clock::now();
  if (!shown_ || now - drawn_at_ < std::chrono::milliseconds(100)) return;
  drawn_at_ = now;
  drawn_ = true;
  constexpr int width = 32;
  fraction = std::clamp(fraction, 0.0, 1.0);
  const int full = static_cast<int>(fraction * width);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double left = fraction > 0 ? elapsed * (1 - fraction) / fraction : 0;
  const std::string line = fmt::format("\r{} [{:#<{}}{:-<{}}] {:3.0f} %, {:.0f} s left\x1b[K", label_, "", full, "",
                                       width - full, fraction * 100, left);
  std::fputs(line.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace kiln
