// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "atlas/charts.h"
#include "atlas/disks.h"
#include "base/progress.h"

namespace kiln {

/// Returns the chart of a disk, without uvs.
Chart chart_of_disk(const Disks& disks, std::uint32_t id);

/// Merges neighbouring charts while the result stays within the bounds of `settings`, then zips slits under the same
/// bounds. `charts[id]` belongs to disk `id` and is valid. Greedy: the runs that make up the largest share of a chart's
/// border first.
void merge_charts(Disks& disks, std::vector<Chart>& charts, const ChartSettings& settings,
                  const ProgressFunction& progress);

}  // namespace kiln
