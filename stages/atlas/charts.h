#pragma once

#include <vector>

#include "atlas/chart.h"
#include "base/progress.h"

namespace kiln {

struct ChartSettings {
  double largest_l2 = 1.005;    ///< stretch of one chart (stretch.h)
  double largest_linf = 2;      ///< of any triangle
  double crease_degrees = 75;   ///< a border that bends more on average stays a seam
  double largest_extent = 0.6;  ///< of a merged chart, over the square root of the surface's area: longer ones pack
                                ///< badly, unless they are compact or rectangles
  double largest_width = 1e9;   ///< of a merged chart's smallest rectangle, the shorter side, over the same
  double clearance = 0;         ///< object units; a merged chart's border does not come nearer to itself in the plane,
                                ///< but where it does so on the surface, too: at corners and along slits
};

struct ChartSet {
  std::vector<Chart> charts;
  int split_charts = 0;  ///< had to be taken apart since no way of flattening them was valid and within the bounds
};

/// Cuts a surface into charts, each a topological disk with a valid map to the plane (parameterise.h): every face that
/// is not degenerate lies in just one. Nearly flat disks are grown first (grow.h), then neighbours are merged as long
/// as the result flattens within the bounds, those first that share most of their border. A single triangle always
/// flattens, so this always ends. Independent of the number of threads.
ChartSet cut_into_charts(const Surface& surface, const ChartSettings& settings,
                         const ProgressFunction& progress = no_progress);

}  // namespace kiln
