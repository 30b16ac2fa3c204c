// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "atlas/chart.h"
#include "base/progress.h"

namespace kiln {

struct ChartSettings {
  double largest_l2 = 1.005;   ///< largest L2 stretch of a chart (stretch.h)
  double largest_linf = 2;     ///< largest L-infinity stretch of a triangle
  double crease_degrees = 75;  ///< a border whose mean bend is larger stays a seam
  /// Largest length of a merged chart, relative to the square root of the surface's area: longer charts pack badly,
  /// unless they are compact or rectangles.
  double largest_extent = 0.6;
  double largest_width = 1e9;  ///< largest width (shorter side of the smallest rectangle) of a merged chart, likewise
  /// Distance, in object units, that borders of merged charts keep from themselves in the plane, except where they are
  /// as near on the surface: at corners and along slits.
  double clearance = 0;
};

struct ChartSet {
  std::vector<Chart> charts;
  int split_charts = 0;  ///< charts taken apart because no way of flattening them was valid and within the bounds
};

/// Cuts a surface into charts, each a topological disk with a valid map to the plane (parameterise.h); every face that
/// is not degenerate lies in exactly one. Nearly flat disks are grown first (grow.h); then neighbours are merged while
/// the result flattens within the bounds, those first that share most of their border. It always ends, because a single
/// triangle always flattens. Independent of the number of threads.
ChartSet cut_into_charts(const Surface& surface, const ChartSettings& settings,
                         const ProgressFunction& progress = no_progress);

}  // namespace kiln
