#include "atlas/place.h"

#include <algorithm>
#include <cmath>
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

/// Bitmaps of about the same width and height: in steps of a tenth.
std::uint32_t size_class(const ChartBitmap& bitmap) {
  const auto step = [](int texels) { return static_cast<std::uint32_t>(std::log(texels) / std::log(1.1)); };
  return step(bitmap.width) << 16 | step(bitmap.height);
}

}  // namespace

Placer::Placer(const std::vector<Shape>& shapes, int width, int height, int gutter, Use use)
    : shapes_(shapes), width_(width), height_(height), gutter_(gutter), use_(use) {
  for (const Shape& shape : shapes) texels_ += static_cast<double>(shape[0].texels);
  const std::size_t grid_bytes = static_cast<std::size_t>(width + 63) / 8 * height;
  step_between_grids_ = use != Use::search ? shapes.size() : 1 + shapes.size() * grid_bytes / most_grid_bytes;
  const std::size_t grids = (shapes.size() + step_between_grids_ - 1) / step_between_grids_;
  for (State* state : {&kept_, &trial_}) {
    state->grids.assign(grids, TexelGrid(width, height));
    state->spots.resize(shapes.size());
    state->heights.resize(shapes.size() + 1);
  }
}

/// The lowest, then leftmost place where a chart fits with its bottom row from `first_row` to `last_row`.
bool Placer::lowest_spot(const TexelGrid& grid, const ChartBitmap& bitmap, int first_row, int last_row, Spot& spot) {
  const int last_x = grid.width() - gutter_ - bitmap.width;
  int blocker = bitmap.widest_row;  // the row of the chart that met something last is the likeliest to do so again
  for (int y = first_row; y <= last_row; ++y) {
    if (grid.longest_free(y + bitmap.widest_row) < bitmap.widest_run) continue;
    int x = gutter_, clear_rows = 0;
    while (clear_rows < bitmap.height && x <= last_x) {
      bool clear = true;
      for (const TexelRun& run : bitmap.rows[blocker]) {
        ++work_;
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
    if (x <= last_x) {
      spot.x = x;
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
  trial_.heights[first] = kept_.heights[first];
  for (std::size_t step = 0; step < first; ++step) trial_.spots[plan.order[step]] = kept_.spots[plan.order[step]];
  highest_top = std::min(highest_top, height_ - gutter_);
  work_ += static_cast<std::int64_t>(width_) * height_ / 2048;  // copying the grid
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
        if (!lowest_spot(grid, bitmap, first_row, last_row, spot)) {
          row_of_class = std::max(row_of_class, last_row);
          continue;
        }
        row_of_class = spot.y;
      } else if (!lowest_spot(grid, bitmap, first_row, last_row, spot)) {
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
