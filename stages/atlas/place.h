// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "atlas/chart_bitmap.h"
#include "atlas/free_runs.h"
#include "atlas/texel_grid.h"

namespace kiln {

/// Bitmaps of a chart, one per rotation tried.
using Shape = std::vector<ChartBitmap>;

/// Part of a chart that is to lie as low as possible.
enum class Objective : std::uint8_t { top, middle };

/// Plan for putting charts down.
struct PlacePlan {
  std::vector<std::uint32_t> order;   ///< charts, in order
  std::vector<Objective> objectives;  ///< per chart
  std::vector<int> rotations;  ///< per chart: a rotation of its shape; any_rotation: the one that comes to lie lowest

  static constexpr int any_rotation = -1;
};

/// Position of a bitmap's lower left texel.
struct Spot {
  int rotation = 0;
  int x = 0;
  int y = 0;
};

/// Puts charts down one by one, each as low as it goes, also into gaps between others. A plan that begins like the one
/// last kept is placed from where they differ.
class Placer {
 public:
  /// Purpose of a placer. A `search` keeps the grid before each step; placing `once` does not. In a `crowd`, a chart
  /// starts a little below where the last one of the same size came to lie, so that placing thousands takes seconds.
  /// seconds.
  enum class Use : std::uint8_t { search, once, crowd };

  /// Makes room for the charts: `width` x `height` texels, of which `gutter` stay free at the border.
  Placer(const std::vector<Shape>& shapes, int width, int height, int gutter, Use use = Use::search);

  /// Height that charts reach; infinite where one did not fit.
  struct Height {
    int top = 0;        ///< number of rows up to the highest texel
    double middle = 0;  ///< mean row of all charts' texels
    bool fits() const { return top < std::numeric_limits<int>::max(); }
  };

  /// Places all charts of a plan that equals the kept one up to step `first`, none higher than row `highest_top`.
  Height place(const PlacePlan& plan, std::size_t first, int highest_top);

  /// Keeps what was placed last.
  void keep();

  const std::vector<Spot>& spots() const { return trial_.spots; }
  /// Returns the work done, as a measure of time that is the same in every run: comparisons of a chart's run with a row
  /// of the grid, and steps that take as long.
  std::int64_t work() const { return work_; }

 private:
  struct State {
    std::vector<TexelGrid> grids;  ///< before each step
    std::vector<Spot> spots;       ///< per chart
    std::vector<Height> heights;   ///< before each step; the mean not yet divided by the number of texels
  };

  struct Rows {
    int first, last;
  };
  bool lowest_spot(const TexelGrid& grid, std::uint32_t chart, Rows rows, Spot& spot);

  const std::vector<Shape>& shapes_;
  int width_, height_, gutter_;
  const Use use_;
  std::size_t step_between_grids_ = 1;
  double texels_ = 0;
  std::size_t first_ = 0;
  std::int64_t work_ = 0;
  State kept_, trial_;
  std::vector<std::vector<std::vector<FreeRuns::Probe>>> probes_;  ///< per chart and rotation, distant rows first
  FreeRuns free_;                                                  ///< free runs of the grid in use
};

}  // namespace kiln
