// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "atlas/chart.h"

namespace kiln {

/// Consecutive texels of a row, both ends included.
struct TexelRun {
  int first = 0;
  int last = 0;
};

/// Texels that a chart occupies when turned by `angle` and scaled, row by row from the bottom, as runs. Texel (0, 0)
/// has its lower left corner at `origin` of the turned and scaled uvs.
struct ChartBitmap {
  int width = 0;
  int height = 0;
  std::vector<std::vector<TexelRun>> rows;
  std::int64_t texels = 0;
  int widest_row = 0;     ///< index of a row that has the longest run
  int widest_run = 0;     ///< length of that run
  double middle_row = 0;  ///< mean row of the texels' centres
  double angle = 0;       ///< radians, counter-clockwise
  Eigen::Vector2d origin = Eigen::Vector2d::Zero();
};

struct BitmapSettings {
  double texels_per_unit = 1;
  double angle = 0;
  double margin = 0.02;        ///< texels by which the chart may grow through rounding
  bool every_touched = false;  ///< also texels that are touched outside their centre
  bool slivers = true;         ///< also texels that slivers touch, see rasterise_chart
};

/// Border of a chart's uvs as segments: all that rasterise_chart needs of a chart.
using ChartOutline = std::vector<std::pair<Eigen::Vector2d, Eigen::Vector2d>>;

ChartOutline chart_outline(const Chart& chart);

/// Rasterises a chart. A texel is needed where its centre lies in the chart or within the margin of it. Slivers between
/// centres also need the texels they touch, unless a needed texel is next to those; two charts two texels apart then
/// never overlap. With `every_touched`, all touched texels are needed and no margin is. `slivers` may be false where
/// the margin is so large that nothing is a sliver.
ChartBitmap rasterise_chart(const ChartOutline& outline, const BitmapSettings& settings);

/// Rotates a uv as the bitmap's chart is rotated.
Eigen::Vector2d turned(const Eigen::Vector2d& uv, double angle);

}  // namespace kiln
