// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/pack_search.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/parallel.h"

namespace kiln {

namespace {

/// Returns the angle that lays a chart's smallest enclosing rectangle along the axes. One side of that rectangle lies
/// along an edge of the convex hull; evenly spread angles would be no worse as far as rasterised charts show.
double rectangle_angle(const ChartOutline& outline) {
  constexpr int steps = 90;
  double best_area = std::numeric_limits<double>::infinity(), best_angle = 0;
  for (int step = 0; step < steps; ++step) {
    const double angle = 0.5 * std::numbers::pi * step / steps;
    Eigen::Matrix2d turn;
    turn << std::cos(angle), -std::sin(angle), std::sin(angle), std::cos(angle);
    Eigen::Vector2d lowest = turn * outline[0].first, highest = lowest;
    for (const auto& [a, b] : outline) {
      const Eigen::Vector2d p = turn * a;
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

double cost_of(const Placer::Height& height) { return height.top + 0.5 * height.middle; }

}  // namespace

Piece piece_of(const Chart& chart) {
  Piece piece;
  piece.outline = chart_outline(chart);
  for (const auto& [a, b] : piece.outline) piece.area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  piece.base_angle = rectangle_angle(piece.outline);
  Eigen::Vector2d lowest = turned(piece.outline[0].first, piece.base_angle), highest = lowest;
  for (const auto& [a, b] : piece.outline) {
    lowest = lowest.cwiseMin(turned(a, piece.base_angle));
    highest = highest.cwiseMax(turned(a, piece.base_angle));
  }
  piece.extent = (highest - lowest).maxCoeff();
  piece.perimeter = 2 * (highest - lowest).sum();
  return piece;
}

PackGrid grid_of(const PackSettings& settings, double zoom) {
  PackGrid grid;
  grid.zoom = zoom;
  grid.bitmap.margin = settings.slack;
  if (zoom == 1) {
    grid.width = settings.width;
    grid.height = settings.height;
    grid.gutter = settings.gutter;
    grid.bitmap.every_touched = settings.gutter < 2;
  } else {
    grid.width = static_cast<int>((settings.width - settings.gutter) * zoom);
    grid.height = static_cast<int>((settings.height - settings.gutter) * zoom);
    grid.bitmap.margin += 0.5 * settings.gutter * zoom;
    grid.bitmap.slivers = false;
  }
  return grid;
}

std::vector<Shape> rasterise(const std::vector<Piece>& pieces, const PackGrid& grid, const Angles& angles,
                             double texels_per_unit) {
  std::vector<Shape> shapes(pieces.size());
  parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
    for (const double angle : angles[i]) {
      BitmapSettings bitmap = grid.bitmap;
      bitmap.texels_per_unit = texels_per_unit * grid.zoom;
      bitmap.angle = angle;
      shapes[i].push_back(rasterise_chart(pieces[i].outline, bitmap));
    }
  });
  return shapes;
}

PackSearch::PackSearch(const std::vector<Piece>& pieces, const PackGrid& grid, Angles angles, std::uint64_t seed,
                       const SearchBounds& bounds)
    : pieces_(pieces), grid_(grid), angles_(std::move(angles)), bounds_(bounds), random_(seed) {}

void PackSearch::start(Aim aim, PlacePlan plan, double texels_per_unit) {
  aim_ = aim;
  plan_ = std::move(plan);
  texels_per_unit_ = texels_per_unit;
  if (aim == Aim::raise_scale)
    start_raising();
  else
    start_lowering();
}

void PackSearch::start_raising() {
  const int room = 3 * grid_.height / 2;
  constexpr int most_shrinks = 60;
  int shrinks = 0;
  for (; shrinks < most_shrinks && !set_scale(texels_per_unit_, room); ++shrinks) texels_per_unit_ *= 0.85;
  for (; shrinks < most_shrinks && height_.top > grid_.top_row(); ++shrinks) {
    texels_per_unit_ *= std::min(0.995, std::sqrt(static_cast<double>(grid_.top_row()) / height_.top));
    if (!set_scale(texels_per_unit_, room)) height_.top = 2 * grid_.height;
  }
  ended_ = shrinks == most_shrinks;
}

void PackSearch::start_lowering() {
  double area = 0, extents = 0;
  for (const Piece& piece : pieces_) {
    area += piece.area;
    extents = std::max(extents, piece.extent);
  }
  const double scale = texels_per_unit_ * grid_.zoom;
  double room = 3 * area * scale * scale / grid_.width + extents * scale + 64;
  for (int tries = 0; !ended_ && !set_scale(texels_per_unit_, static_cast<int>(std::min(room, 1e6))); room *= 2)
    ended_ = ++tries == 8;
  if (!ended_) keep_found();
}

void PackSearch::advance(double share) {
  const auto until = static_cast<std::int64_t>(share * static_cast<double>(bounds_.work));
  while (!ended_ && work() < until) {
    // Rows are whole numbers, and the height found is a row divided by the zoom: half a row is more than its rounding.
    const bool better = aim_ == Aim::raise_scale ? height_.top <= grid_.top_row()
                                                 : height_.top < found_.back().height * grid_.zoom - 0.5;
    if (better) {
      keep_found();
      changes_in_vain_ = 0;
      if (aim_ == Aim::lower_height) continue;
      texels_per_unit_ *= std::clamp(std::sqrt(static_cast<double>(grid_.top_row()) / height_.top), 1.003, 1.05);
      // Where a chart no longer fits between the sides, a slightly smaller scale may do.
      ended_ = !set_scale(texels_per_unit_, 3 * grid_.height / 2) &&
               !set_scale(texels_per_unit_ = 1.003 * found_.back().texels_per_unit, 3 * grid_.height / 2);
    } else if (++changes_in_vain_ > bounds_.changes_in_vain) {
      ended_ = true;
    } else {
      change(1 - static_cast<double>(work()) / static_cast<double>(bounds_.work));
    }
  }
}

/// Draws the pieces and puts them down in a grid `room` high; tells whether they fit.
bool PackSearch::set_scale(double texels_per_unit, int room) {
  work_ = work();
  placer_.reset();
  shapes_ = rasterise(pieces_, grid_, angles_, texels_per_unit);
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    work_ += static_cast<std::int64_t>(
        (4 * pieces_[i].outline.size() + 20 * static_cast<std::size_t>(shapes_[i][0].height)) * angles_[i].size());
  placer_.emplace(shapes_, grid_.width, room + grid_.gutter, grid_.gutter);
  height_ = placer_->place(plan_, 0, std::numeric_limits<int>::max());
  if (!height_.fits()) return false;
  placer_->keep();
  spots_ = placer_->spots();
  return true;
}

/// Tries a change and keeps it where it is no worse, or, by chance, a little worse.
void PackSearch::change(double temperature) {
  PlacePlan plan = plan_;
  const std::size_t count = pieces_.size();
  std::size_t first = pick(count);
  const double kind = chance();
  if (kind < 0.35 && count > 1) {
    const std::size_t other = pick(count);
    std::swap(plan.order[first], plan.order[other]);
    first = std::min(first, other);
  } else if (kind < 0.7 && count > 1) {
    const std::size_t to = pick(count);
    const auto from = plan.order.begin() + static_cast<std::ptrdiff_t>(first);
    const auto there = plan.order.begin() + static_cast<std::ptrdiff_t>(to);
    if (first < to)
      std::rotate(from, from + 1, there + 1);
    else
      std::rotate(there, from, from + 1);
    first = std::min(first, to);
  } else if (kind < 0.8) {
    Objective& objective = plan.objectives[plan.order[first]];
    objective = objective == Objective::top ? Objective::middle : Objective::top;
  } else {
    int& rotation = plan.rotations[plan.order[first]];
    rotation = rotation != PlacePlan::any_rotation && chance() < 0.5
                   ? PlacePlan::any_rotation
                   : static_cast<int>(pick(angles_[plan.order[first]].size()));
  }
  const double allowed = 0.003 * grid_.height * temperature * -std::log(1 - chance());
  const double most = cost_of(height_) + allowed;
  ++work_;
  const Placer::Height height =
      placer_->place(plan, first, static_cast<int>(std::min(most - 0.25 * height_.middle, 1e9)));
  if (!height.fits() || cost_of(height) > most) return;
  placer_->keep();
  spots_ = placer_->spots();
  plan_ = std::move(plan);
  height_ = height;
}

void PackSearch::keep_found() {
  constexpr std::size_t most_kept = 4;
  if (found_.size() == most_kept) found_.pop_front();
  found_.push_back({texels_per_unit_, height_.top / grid_.zoom, plan_, {}});
  for (std::size_t i = 0; i < pieces_.size(); ++i) found_.back().angles.push_back(angles_[i][spots_[i].rotation]);
}

}  // namespace kiln
