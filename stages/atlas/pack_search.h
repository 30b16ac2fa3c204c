// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <deque>
#include <limits>
#include <optional>
#include <random>
#include <vector>

#include "atlas/pack.h"
#include "atlas/place.h"

namespace kiln {

/// Properties of a chart that packing needs.
struct Piece {
  ChartOutline outline;
  double area = 0;
  double extent = 0;     ///< longer side of its smallest rectangle
  double perimeter = 0;  ///< perimeter of that rectangle
  double base_angle = 0;
};

Piece piece_of(const Chart& chart);

/// The atlas at some resolution. At a coarser one than the texels', each piece is drawn half a gutter larger to all
/// sides.
struct PackGrid {
  double zoom = 1;  ///< grid texels per texel
  int width = 0;
  int height = 0;  ///< height that charts should keep to
  int gutter = 0;
  BitmapSettings bitmap;

  int top_row() const { return height - gutter; }
};

PackGrid grid_of(const PackSettings& settings, double zoom);

using Angles = std::vector<std::vector<double>>;  ///< per piece, the angles to try

std::vector<Shape> rasterise(const std::vector<Piece>& pieces, const PackGrid& grid, const Angles& angles,
                             double texels_per_unit);

/// Plan for putting pieces down that fitted.
struct FoundPlan {
  double texels_per_unit = 0;
  double height = std::numeric_limits<double>::infinity();  ///< height used, texels
  PlacePlan plan;
  std::vector<double> angles;  ///< per piece
};

/// Bounds of a search, which ends when one of the two is reached.
struct SearchBounds {
  std::int64_t work = 0;    ///< as Placer counts it
  int changes_in_vain = 0;  ///< failed changes in a row
};

/// Searches for better orders by small changes, at one resolution: simulated annealing, the same in every run.
class PackSearch {
 public:
  enum class Aim : std::uint8_t { raise_scale, lower_height };

  /// Starts with a plan. Where the scale is to be raised, it starts at `texels_per_unit`, which may be too large.
  PackSearch(const std::vector<Piece>& pieces, const PackGrid& grid, Angles angles, std::uint64_t seed,
             const SearchBounds& bounds);
  void start(Aim aim, PlacePlan plan, double texels_per_unit);

  /// Continues the search until `share` of all work is done.
  void advance(double share);

  /// Returns the plans that fitted, the best (last found) first; empty if none did.
  std::vector<FoundPlan> found() const { return {found_.rbegin(), found_.rend()}; }

 private:
  std::int64_t work() const { return work_ + (placer_ ? placer_->work() : 0); }
  double chance() { return static_cast<double>(random_() >> 11) * 0x1p-53; }  // the same on every platform
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(chance() * static_cast<double>(count)); }

  void start_raising();
  void start_lowering();
  bool set_scale(double texels_per_unit, int room);
  void change(double temperature);
  void keep_found();

  const std::vector<Piece>& pieces_;
  const PackGrid grid_;
  const Angles angles_;
  const SearchBounds bounds_;
  Aim aim_ = Aim::raise_scale;
  bool ended_ = false;
  std::mt19937_64 random_;
  std::int64_t work_ = 0;
  int changes_in_vain_ = 0;
  double texels_per_unit_ = 0;
  std::vector<Shape> shapes_;
  std::optional<Placer> placer_;
  PlacePlan plan_;
  Placer::Height height_;
  std::vector<Spot> spots_;
  std::deque<FoundPlan> found_;  ///< the last ones, each better than those before
};

}  // namespace kiln
