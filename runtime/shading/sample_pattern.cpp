// SPDX-License-Identifier: MIT
#include "runtime/shading/sample_pattern.h"

#include <numeric>

namespace kiln {

namespace {

/// Returns the squared distance from a lattice's origin to its nearest other sample, in cells, wrapped around.
int nearest_squared(int count, int step) {
  const auto wrapped = [count](int cells) { return std::min(cells, count - cells); };
  int nearest = 2 * count * count;
  for (int k = 1; k < count; ++k) {
    const int across = wrapped(k), up = wrapped(step * k % count);
    nearest = std::min(nearest, across * across + up * up);
  }
  return nearest;
}

}  // namespace

std::vector<Eigen::Vector2d> sample_pattern(int count) {
  int best = 1;
  for (int step = 2; step < count; ++step)
    if (std::gcd(step, count) == 1 && nearest_squared(count, step) > nearest_squared(count, best)) best = step;
  std::vector<Eigen::Vector2d> places;
  for (int k = 0; k < count; ++k) places.emplace_back((k + 0.5) / count, (best * k % count + 0.5) / count);
  return places;
}

}  // namespace kiln
