#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "atlas/chart_bitmap.h"
#include "atlas/free_runs.h"
#include "atlas/texel_grid.h"

namespace kiln {

/// A chart in all the rotations that are tried.
using Shape = std::vector<ChartBitmap>;

/// What is put down of a chart as low as it can be.
enum class Objective : std::uint8_t { top, middle };

/// How charts are put down.
struct PlacePlan {
  std::vector<std::uint32_t> order;   ///< of charts
  std::vector<Objective> objectives;  ///< per chart
  std::vector<int> rotations;         ///< per chart, of its shape; any_rotation: the one that comes to lie lowest

  static constexpr int any_rotation = -1;
};

/// Where a bitmap's lower left texel goes.
struct Spot {
  int rotation = 0;
  int x = 0;
  int y = 0;
};

/// Puts charts down one by one, each as low as it goes, also in the gaps of others. Plans that begin like the one kept
/// last are placed from where they differ.
class Placer {
 public:
  /// A search keeps the grid before each step, placing once does not. In a crowd, a chart starts a little below where
  /// the one of the same size before it came to lie, so that placing thousands takes seconds.
  enum class Use : std::uint8_t { search, once, crowd };

  /// Room for the charts: `width` x `height` texels, of which `gutter` stay free at the border.
  Placer(const std::vector<Shape>& shapes, int width, int height, int gutter, Use use = Use::search);

  /// How high charts come up: where infinite, one did not fit.
  struct Height {
    int top = 0;        ///< rows up to the highest texel
    double middle = 0;  ///< mean row of all charts' texels
    bool fits() const { return top < std::numeric_limits<int>::max(); }
  };

  /// Places all charts of a plan that is the kept one's up to step `first`, none higher than row `highest_top`.
  Height place(const PlacePlan& plan, std::size_t first, int highest_top);

  /// Keeps what was placed last.
  void keep();

  const std::vector<Spot>& spots() const { return trial_.spots; }
  /// Comparisons of a chart's run with a row of the grid, and what takes as long: a measure of time that is the same in
  /// every run.
  std::int64_t work() const { return work_; }

 private:
  struct State {
    std::vector<TexelGrid> grids;  ///< before each step
    std::vector<Spot> spots;       ///< per chart
    std::vector<Height> heights;   ///< before each step; the mean times the texels
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
  std::vector<std::vector<std::vector<FreeRuns::Probe>>> probes_;  ///< per chart and rotation, those apart first
  FreeRuns free_;                                                  ///< of the grid that a chart is placed in
};

}  // namespace kiln
