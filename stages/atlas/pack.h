// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <vector>

#include "atlas/chart.h"
#include "base/progress.h"

namespace kiln {

/// Settings of packing. Either the width and height of the atlas are given and the scale is free; or `texels_per_unit`
/// is given and the atlas is as small as can be found: of the least height for a given width, or the smallest square.
struct PackSettings {
  int width = 512;   ///< width of the atlas, texels; with `texels_per_unit`, 0 (and `height` 0) asks for a square
  int height = 512;  ///< with `texels_per_unit`, 0 asks for the least height
  double texels_per_unit = 0;  ///< 0: the largest scale that is found to fit
  int size_multiple = 4;       ///< a width or height to be found is a multiple of this
  int gutter = 4;              ///< free texels between the covered ones of two charts, and at the border
  int rotations = 16;          ///< angles tried per chart, spread evenly from that of its smallest rectangle
  bool thorough = false;       ///< search some ten times as long
  double slack = 0;            ///< texels that uvs may still move; 0: what rounding them to 16 bits moves them
  std::uint64_t seed = 1;
};

/// Place of a chart: atlas texel = turned(uv, angle) * texels_per_unit + offset.
struct ChartPlacement {
  double angle = 0;
  Eigen::Vector2d offset = Eigen::Vector2d::Zero();
};

struct Packing {
  int width = 0;  ///< width of the atlas, texels
  int height = 0;
  double texels_per_unit = 0;
  std::vector<ChartPlacement> placements;  ///< per chart
};

/// Packs charts, all at the same scale, into the atlas at texel resolution. One after the other is turned and put as
/// far down as it goes, also into gaps between others, in the order that annealing finds; the scale is the largest
/// found, or that given. Independent of the number of threads. Throws WrongUsage where the atlas is too small for so
/// many charts and such a gutter.
Packing pack_charts(const std::vector<Chart>& charts, const PackSettings& settings,
                    const ProgressFunction& progress = no_progress);

}  // namespace kiln
