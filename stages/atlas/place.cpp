// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/place.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <unordered_map>

namespace kiln {

namespace {

constexpr std::size_t most_grid_bytes = std::size_t{64} << 20;

void occupy(TexelGrid& grid, const ChartBitmap& bitmap, const Spot& spot, int gutter) {
  for (int row = 0; row < bitmap.height; ++row)
    for (const TexelRun& run : bitmap.rows[row])
      for (int y = spot.y + row - gutter; y <= spot.y + row + gutter; ++y)
        grid.take(y, spot.x + run.first - gutter, spot.x + run.last + gutter);
}

/// Classifies bitmaps by width and height, in steps of a tenth.
std::uint32_t size_class(const ChartBitmap& bitmap) {
  const auto step = [](int texels) { return static_cast<std::uint32_t>(std::log(texels) / std::log(1.1)); };
  return step(bitmap.width) << 16 | step(bitmap.height);
}

int longest_run(const std::vector<Shape>& shapes) {
  int longest = 0;
  for (const Shape& shape : shapes)
    for (const ChartBitmap& bitmap : shape) longest = std::max(longest, bitmap.widest_run);
  return longest;
}

/// Returns the stride by which a search visits rows. Neighbouring rows are blocked by the same charts, so consecutive
/// rows of the search lie apart, yet each is visited once.
int row_stride(int height) {
  int stride = std::max(1, static_cast<int>(0.382 * height));  // the golden section
  while (std::gcd(stride, height) != 1) ++stride;
  return stride;
}

/// Sets the bits from `first` to `last`, as far as they exist, and clears all others.
void set_between(int first, int last, FreeRuns::Mask& mask) {
  for (int word = 0; word < FreeRuns::span_words; ++word) {
    const int low = std::max(first - 64 * word, 0), high = std::min(last - 64 * word, 63);
    mask[word] = low <= high ? ~std::uint64_t{0} << low & ~std::uint64_t{0} >> (63 - high) : 0;
  }
}

bool none(const FreeRuns::Mask& mask) { return (mask[0] | mask[1] | mask[2] | mask[3]) == 0; }

int lowest_bit(const FreeRuns::Mask& mask) {
  int word = 0;
  while (mask[word] == 0) ++word;
  return 64 * word + __builtin_ctzll(mask[word]);
}

}  // namespace

Placer::Placer(const std::vector<Shape>& shapes, int width, int height, int gutter, Use use)
    : shapes_(shapes),
      width_(width),
      height_(height),
      gutter_(gutter),
      use_(use),
      free_(width, height, longest_run(shapes)) {
  for (const Shape& shape : shapes) texels_ += static_cast<double>(shape[0].texels);
  const std::size_t grid_bytes = static_cast<std::size_t>(width + 63) / 8 * height;
  step_between_grids_ = use != Use::search ? shapes.size() : 1 + shapes.size() * grid_bytes / most_grid_bytes;
  const std::size_t grids = (shapes.size() + step_between_grids_ - 1) / step_between_grids_;
  probes_.resize(shapes.size());
  for (std::size_t chart = 0; chart < shapes.size(); ++chart)
    for (const ChartBitmap& bitmap : shapes[chart]) {
      std::vector<FreeRuns::Probe>& probes = probes_[chart].emplace_back();
      const int stride = row_stride(bitmap.height);
      int row = bitmap.widest_row;
      for (int i = 0; i < bitmap.height; ++i, row = (row + stride) % bitmap.height)
        for (const TexelRun& run : bitmap.rows[row]) free_.append_probes(row, run, probes);
    }
  for (State* state : {&kept_, &trial_}) {
    state->grids.assign(grids, TexelGrid(width, height));
    state->spots.resize(shapes.size());
    state->heights.resize(shapes.size() + 1);
  }
}

/// Finds the lowest, then leftmost place where a chart fits with its bottom row from `first_row` to `last_row`.
bool Placer::lowest_spot(const TexelGrid& grid, std::uint32_t chart, Rows rows, Spot& spot) {
  const ChartBitmap& bitmap = shapes_[chart][spot.rotation];
  const std::vector<FreeRuns::Probe>& probes = probes_[chart][spot.rotation];
  const int last_x = grid.width() - gutter_ - bitmap.width;
  std::size_t blocker = 0;  // the probe that last met something is likeliest to do so again
  for (int y = rows.first; y <= rows.last; ++y) {
    if (grid.longest_free(y + bitmap.widest_row) < bitmap.widest_run) continue;
    for (int start = gutter_ / 64 * 64; start <= last_x; start += FreeRuns::span) {
      FreeRuns::Mask places;
      set_between(gutter_ - start, last_x - start, places);
      std::size_t passed = 0;
      for (; passed < probes.size(); ++passed) {
        free_.keep_free(probes[blocker], y, start, places);
        if (none(places)) break;
        if (++blocker == probes.size()) blocker = 0;
      }
      work_ += static_cast<std::int64_t>(passed + 1);
      if (passed < probes.size()) continue;
      spot.x = start + lowest_bit(places);
      spot.y = y;
      return true;
    }
  }
  return false;
}

Placer::Height Placer::place(const PlacePlan& plan, std::size_t first, int highest_top) {
  first = first / step_between_grids_ * step_between_grids_;
  first_ = first;
  TexelGrid grid = kept_.grids[first / step_between_grids_];
  work_ += free_.update(grid, 0, height_ - 1) / 8;
  trial_.heights[first] = kept_.heights[first];
  for (std::size_t step = 0; step < first; ++step) trial_.spots[plan.order[step]] = kept_.spots[plan.order[step]];
  highest_top = std::min(highest_top, height_ - gutter_);
  work_ += static_cast<std::int64_t>(width_) * height_ / 2048;  // for copying the grid
  std::unordered_map<std::uint32_t, int> rows_of_classes;
  for (std::size_t step = first; step < plan.order.size(); ++step) {
    if (step % step_between_grids_ == 0) trial_.grids[step / step_between_grids_] = grid;
    const std::uint32_t chart = plan.order[step];
    double best_cost = std::numeric_limits<double>::infinity();
    Spot best;
    const bool any = plan.rotations[chart] == PlacePlan::any_rotation;
    const int first_rotation = any ? 0 : plan.rotations[chart];
    const int last_rotation = any ? static_cast<int>(shapes_[chart].size()) - 1 : first_rotation;
    for (int rotation = first_rotation; rotation <= last_rotation; ++rotation) {
      const ChartBitmap& bitmap = shapes_[chart][rotation];
      const double height = plan.objectives[chart] == Objective::top ? bitmap.height : bitmap.middle_row;
      int last_row = highest_top - bitmap.height;
      if (std::isfinite(best_cost)) last_row = std::min(last_row, static_cast<int>(std::floor(best_cost - height)));
      Spot spot{rotation, 0, 0};
      int first_row = gutter_;
      if (use_ == Use::crowd) {
        int& row_of_class = rows_of_classes.emplace(size_class(bitmap), gutter_).first->second;
        first_row = std::max(gutter_, row_of_class - bitmap.height / 4);
        if (!lowest_spot(grid, chart, {first_row, last_row}, spot)) {
          row_of_class = std::max(row_of_class, last_row);
          continue;
        }
        row_of_class = spot.y;
      } else if (!lowest_spot(grid, chart, {first_row, last_row}, spot)) {
        continue;
      }
      const double cost = spot.y + height + 1e-4 * spot.x;
      if (cost < best_cost) {
        best_cost = cost;
        best = spot;
      }
    }
    if (!std::isfinite(best_cost)) return {std::numeric_limits<int>::max(), 0};
    trial_.spots[chart] = best;
    const ChartBitmap& bitmap = shapes_[chart][best.rotation];
    occupy(grid, bitmap, best, gutter_);
    work_ += free_.update(grid, best.y - gutter_, best.y + bitmap.height - 1 + gutter_) / 8;
    work_ += static_cast<std::int64_t>(bitmap.height) * (2 * gutter_ + 1);
    Height& height = trial_.heights[step + 1];
    height = trial_.heights[step];
    height.top = std::max(height.top, best.y + bitmap.height);
    height.middle += (best.y + bitmap.middle_row) * static_cast<double>(bitmap.texels);
  }
  Height result = trial_.heights.back();
  result.middle /= texels_;
  return result;
}

void Placer::keep() {
  for (std::size_t grid = first_ / step_between_grids_; grid < trial_.grids.size(); ++grid)
    std::swap(kept_.grids[grid], trial_.grids[grid]);
  kept_.spots = trial_.spots;
  for (std::size_t step = first_; step < trial_.heights.size(); ++step) kept_.heights[step] = trial_.heights[step];
}

}  // namespace kiln
