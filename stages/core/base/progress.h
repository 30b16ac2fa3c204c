// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>

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

}  // namespace kiln
