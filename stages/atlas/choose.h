// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "atlas/charts.h"
#include "atlas/pack.h"
#include "base/progress.h"

namespace kiln {

/// Cuts a surface in several ways, which differ in how long charts may become, and returns the charts that pack best in
/// a quick attempt with the given settings: at the largest scale or, where the scale is given, into the fewest texels.
ChartSet choose_charts(const Surface& surface, const ChartSettings& charts, const PackSettings& pack,
                       const ProgressFunction& progress = no_progress);

}  // namespace kiln
