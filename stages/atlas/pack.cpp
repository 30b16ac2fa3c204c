#include "atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <tbb/parallel_for.h>

#include "atlas/chart_bitmap.h"
#include "atlas/texel_grid.h"
#include "base/errors.h"

namespace kiln {

namespace {

/// What is put down of a chart as low as it can be.
enum class Objective { top, middle };

struct Attempt {
  std::vector<std::uint32_t> order;
  Objective objective = Objective::top;
};

struct Spot {
  int rotation = 0;
  int x = 0;
  int y = 0;
};

/// All charts in all rotations at one scale.
using Bitmaps = std::vector<std::vector<ChartBitmap>>;

/// The angle that lays a chart's smallest enclosing rectangle along the axes. One side of it lies along an edge of the
/// convex hull; trying evenly spread angles instead is as good as can be told after rasterising.
double rectangle_angle(const Chart& chart) {
  constexpr int steps = 90;
  double best_area = std::numeric_limits<double>::infinity(), best_angle = 0;
  for (int step = 0; step < steps; ++step) {
    const double angle = 0.5 * std::numbers::pi * step / steps;
    Eigen::Vector2d lowest = turned(chart.uvs[0], angle), highest = lowest;
    for (const Eigen::Vector2d& uv : chart.uvs) {
      const Eigen::Vector2d p = turned(uv, angle);
      lowest = lowest.cwiseMin(p);
      highest = highest.cwiseMax(p);
    }
    const double area = (highest - lowest).prod();
    if (area < best_area * (1 - 1e-9)) {
      best_area = area;
      best_angle = angle;
    }
  }
  return best_angle;
}

/// The lowest, then leftmost place where a chart fits with its bottom row in `first_row` to `last_row`.
std::optional<Spot> lowest_spot(const TexelGrid& grid, const ChartBitmap& bitmap, int gutter, int first_row,
                                int last_row) {
  const int last_x = grid.width() - gutter - bitmap.width;
  int blocker = 0;  // the row of the chart that met something last is the likeliest to do so again
  for (int y = first_row; y <= last_row; ++y) {
    int x = gutter, clear_rows = 0;
    while (clear_rows < bitmap.height && x <= last_x) {
      bool clear = true;
      for (const TexelRun& run : bitmap.rows[blocker]) {
        const int taken = grid.last_taken(y + blocker, x + run.first, x + run.last);
        if (taken < 0) continue;
        x = taken - run.first + 1;  // no place before that one can be free
        clear = false;
        if (x > last_x) break;
      }
      if (!clear) {
        clear_rows = 0;
        continue;
      }
      ++clear_rows;
      blocker = blocker + 1 == bitmap.height ? 0 : blocker + 1;
    }
    if (x <= last_x) return Spot{0, x, y};
  }
  return {};
}

void occupy(TexelGrid& grid, const ChartBitmap& bitmap, const Spot& spot, int gutter) {
  for (int row = 0; row < bitmap.height; ++row)
    for (const TexelRun& run : bitmap.rows[row])
      for (int y = spot.y + row - gutter; y <= spot.y + row + gutter; ++y)
        grid.take(y, spot.x + run.first - gutter, spot.x + run.last + gutter);
}

double middle_row(const ChartBitmap& bitmap) {
  double sum = 0;
  for (int row = 0; row < bitmap.height; ++row)
    for (const TexelRun& run : bitmap.rows[row]) sum += (row + 0.5) * (run.last - run.first + 1);
  return sum / static_cast<double>(bitmap.texels);
}

/// One attempt at one scale: a spot per chart, or nothing where one does not fit.
std::optional<std::vector<Spot>> place_all(const Bitmaps& bitmaps, const Attempt& attempt,
                                           const PackSettings& settings) {
  TexelGrid grid(settings.width, settings.height);
  std::vector<Spot> spots(bitmaps.size());
  for (const std::uint32_t chart : attempt.order) {
    double best_cost = std::numeric_limits<double>::infinity();
    Spot best;
    for (int rotation = 0; rotation < static_cast<int>(bitmaps[chart].size()); ++rotation) {
      const ChartBitmap& bitmap = bitmaps[chart][rotation];
      const double height = attempt.objective == Objective::top ? bitmap.height : middle_row(bitmap);
      int last_row = settings.height - settings.gutter - bitmap.height;
      if (std::isfinite(best_cost)) last_row = std::min(last_row, static_cast<int>(std::floor(best_cost - height)));
      const std::optional<Spot> spot = lowest_spot(grid, bitmap, settings.gutter, settings.gutter, last_row);
      if (!spot) continue;
      const double cost = spot->y + height + 1e-4 * spot->x;
      if (cost < best_cost) {
        best_cost = cost;
        best = *spot;
        best.rotation = rotation;
      }
    }
    if (!std::isfinite(best_cost)) return {};
    spots[chart] = best;
    occupy(grid, bitmaps[chart][best.rotation], best, settings.gutter);
  }
  return spots;
}

class Packer {
 public:
  Packer(const std::vector<Chart>& charts, const PackSettings& settings)
      : charts_(charts), settings_(settings), random_(settings.seed) {
    for (const Chart& chart : charts) {
      base_angles_.push_back(rectangle_angle(chart));
      double area = 0, longest = 0;
      for (const Triangle& t : chart.triangles) area += 0.5 * cross(chart.uvs[t[0]], chart.uvs[t[1]], chart.uvs[t[2]]);
      Eigen::Vector2d lowest = chart.uvs[0], highest = lowest;
      for (const Eigen::Vector2d& uv : chart.uvs) {
        lowest = lowest.cwiseMin(turned(uv, base_angles_.back()));
        highest = highest.cwiseMax(turned(uv, base_angles_.back()));
      }
      longest = (highest - lowest).maxCoeff();
      areas_.push_back(area);
      extents_.push_back(longest);
      total_area_ += area;
    }
  }

  Packing run(const ProgressFunction& progress) {
    // Step 1: the largest scale that the plainest order fits at, by bisection over the share of the atlas covered.
    const double full_scale = std::sqrt(static_cast<double>(settings_.width) * settings_.height / total_area_);
    double fits = 0, too_large = 1;
    for (int step = 0; step < 7 || (fits == 0 && step < 24); ++step) {
      const double share = 0.5 * (fits + too_large);
      (attempt_at(full_scale * std::sqrt(share), {plain_attempt(Objective::top)}) ? fits : too_large) = share;
      progress(0.04 * step);
    }
    if (best_.placements.empty())
      throw WrongUsage("an atlas of " + std::to_string(settings_.width) + " x " + std::to_string(settings_.height) +
                       " texels is too small for " + std::to_string(charts_.size()) + " charts with a gutter of " +
                       std::to_string(settings_.gutter) + "; choose a larger --size or a smaller --gutter");

    // Step 2: a little larger each time, with several orders; smaller steps where none fits.
    double growth = 1.02;
    for (int round = 0; round < settings_.rounds && growth > 1.0015; ++round) {
      std::vector<Attempt> attempts;
      for (int i = 0; i < attempts_per_round; ++i) attempts.push_back(varied_attempt(i));
      if (!attempt_at(best_.texels_per_unit * growth, attempts)) growth = 1 + 0.5 * (growth - 1);
      progress(0.3 + 0.7 * round / settings_.rounds);
    }
    return best_;
  }

 private:
  static constexpr int attempts_per_round = 6;

  Attempt plain_attempt(Objective objective) const {
    Attempt attempt{std::vector<std::uint32_t>(charts_.size()), objective};
    std::iota(attempt.order.begin(), attempt.order.end(), 0u);
    std::stable_sort(attempt.order.begin(), attempt.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return extents_[a] > extents_[b]; });
    return attempt;
  }

  /// An order by size, where each chart's size is first changed a little by chance.
  Attempt varied_attempt(int index) {
    Attempt attempt{std::vector<std::uint32_t>(charts_.size()), index % 2 == 0 ? Objective::top : Objective::middle};
    std::vector<double> sizes(charts_.size());
    for (std::size_t i = 0; i < charts_.size(); ++i) {
      const double chance = static_cast<double>(random_() >> 11) * 0x1p-53;  // the same on every platform
      sizes[i] = (index / 2 % 2 == 0 ? extents_[i] : std::sqrt(areas_[i])) * (1 + 0.5 * chance);
    }
    std::iota(attempt.order.begin(), attempt.order.end(), 0u);
    std::stable_sort(attempt.order.begin(), attempt.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return sizes[a] > sizes[b]; });
    return attempt;
  }

  /// Keeps the first attempt that fits, and says whether one did.
  bool attempt_at(double texels_per_unit, const std::vector<Attempt>& attempts) {
    const Bitmaps bitmaps = rasterise_all(texels_per_unit);
    std::vector<std::optional<std::vector<Spot>>> results(attempts.size());
    tbb::parallel_for(std::size_t{0}, attempts.size(),
                      [&](std::size_t i) { results[i] = place_all(bitmaps, attempts[i], settings_); });
    for (const std::optional<std::vector<Spot>>& spots : results) {
      if (!spots) continue;
      best_.texels_per_unit = texels_per_unit;
      best_.placements.resize(charts_.size());
      for (std::size_t i = 0; i < charts_.size(); ++i) {
        const Spot& spot = (*spots)[i];
        const ChartBitmap& bitmap = bitmaps[i][spot.rotation];
        best_.placements[i] = {bitmap.angle, Eigen::Vector2d(spot.x, spot.y) - bitmap.origin};
      }
      return true;
    }
    return false;
  }

  Bitmaps rasterise_all(double texels_per_unit) const {
    Bitmaps bitmaps(charts_.size());
    tbb::parallel_for(std::size_t{0}, charts_.size(), [&](std::size_t i) {
      for (int rotation = 0; rotation < settings_.rotations; ++rotation) {
        BitmapSettings bitmap;
        bitmap.texels_per_unit = texels_per_unit;
        bitmap.angle = base_angles_[i] + 2 * std::numbers::pi * rotation / settings_.rotations;
        bitmap.margin = settings_.slack;
        bitmap.every_touched = settings_.gutter < 2;
        bitmaps[i].push_back(rasterise_chart(charts_[i], bitmap));
      }
    });
    return bitmaps;
  }

  const std::vector<Chart>& charts_;
  const PackSettings& settings_;
  std::mt19937_64 random_;
  std::vector<double> base_angles_, areas_, extents_;
  double total_area_ = 0;
  Packing best_;
};

}  // namespace

Packing pack_charts(const std::vector<Chart>& charts, const PackSettings& settings, const ProgressFunction& progress) {
  if (charts.empty()) return {};
  return Packer(charts, settings).run(progress);
}

}  // namespace kiln
