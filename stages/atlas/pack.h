#pragma once

#include <cstdint>
#include <vector>

#include "atlas/chart.h"
#include "base/progress.h"

namespace kiln {

struct PackSettings {
  int width = 512;  ///< of the atlas, texels
  int height = 512;
  int gutter = 4;       ///< free texels between the covered ones of two charts, and at the border
  int rotations = 16;   ///< angles tried per chart, evenly spread from that of its smallest rectangle
  int rounds = 10;      ///< of attempts at a larger scale, each with several orders of the charts
  double slack = 0.02;  ///< texels that uvs may still move, through rounding
  std::uint64_t seed = 1;
};

/// Where a chart goes: atlas texel = turned(uv, angle) * texels_per_unit + offset.
struct Placement {
  double angle = 0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
};

struct Packing {
  double texels_per_unit = 0;
  std::vector<Placement> placements;  ///< per chart
};

/// Packs charts, all at the same scale, into the atlas at texel resolution: largest first, each turned and put as far
/// down as it goes, in the gaps of others where it fits; the scale is the largest found. Independent of the number of
/// threads. Throws WrongUsage where the atlas is too small for so many charts and such a gutter.
Packing pack_charts(const std::vector<Chart>& charts, const PackSettings& settings,
                    const ProgressFunction& progress = no_progress);

}  // namespace kiln
