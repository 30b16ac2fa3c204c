// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "raycast/surface_cache.h"

namespace kiln {

/// Vectors that the points of a surface send out: for each point channels * coefficients numbers, channel after
/// channel.
struct SentLight {
  int channels = 1;
  int coefficients = 0;
  std::vector<float> values;  ///< empty: the surface sends nothing

  int width() const { return channels * coefficients; }

  /// Adds as many values, to all zeros if there are none.
  void add(std::span<const float> sent);
};

/// Returns values, as SentLight has them, that the points of `cache` send out when they receive the transfer vectors
/// that plane(channel, coefficient) has for all points: albedo times transfer.
std::vector<float> reflected(const SurfaceCache& cache, int channels, int coefficients,
                             const std::function<std::span<const float>(int channel, int coefficient)>& plane);

}  // namespace kiln
