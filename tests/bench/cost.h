// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <limits>

namespace kiln {

/// Wall-clock and processor seconds of a piece of work, over all threads.
struct Cost {
  double wall = std::numeric_limits<double>::infinity(), cpu = std::numeric_limits<double>::infinity();

  Cost operator+(const Cost& other) const { return {wall + other.wall, cpu + other.cpu}; }
};

template <class Work>
Cost cost_of(const Work& work) {
  const auto start = std::chrono::steady_clock::now();
  const std::clock_t begin = std::clock();
  work();
  return {std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count(),
          static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC};
}

inline Cost lesser(const Cost& a, const Cost& b) { return {std::min(a.wall, b.wall), std::min(a.cpu, b.cpu)}; }

}  // namespace kiln
