#pragma once

#include "atlas/charts.h"
#include "atlas/pack.h"

namespace kiln {

/// Cuts a surface in several ways, which differ in how long charts may become, and returns the charts that pack best
/// with the given settings, in a quick attempt each: into the atlas at the largest scale or, where the scale is given,
/// into the fewest texels.
ChartSet choose_charts(const Surface& surface, const ChartSettings& charts, const PackSettings& pack,
                       const ProgressFunction& progress = no_progress);

}  // namespace kiln
