// SPDX-License-Identifier: GPL-3.0-or-later
// The search runs over orders in which charts are put down, bottom left first ([Baker 1980]; with turned bitmaps as in
// [Levy 2002], section 4): simulated annealing at a resolution at which one packing takes less than a millisecond. Its
// best orders are then placed at the resolution of the texels.
#include "atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <memory>
#include <numbers>
#include <numeric>
#include <optional>

#include "atlas/pack_search.h"
#include "atlas/place.h"
#include "base/errors.h"
#include "base/parallel.h"

namespace kiln {

namespace {

/// Packs into an atlas that is not wider than high, or of a given width.
class Packer {
 public:
  Packer(const std::vector<Chart>& charts, const PackSettings& settings)
      : settings_(settings), find_slack_(settings.slack == 0), pieces_(charts.size()) {
    parallel_for(std::size_t{0}, charts.size(), [&](std::size_t i) { pieces_[i] = piece_of(charts[i]); });
    for (const Piece& piece : pieces_) area_ += piece.area;
    if (settings.width > 0 && settings.height > 0) set_size(settings.width, settings.height);
  }

  /// Finds a packing of the largest scale.
  std::optional<Packing> at_largest_scale(const ProgressFunction& progress) {
    if (crowd()) return crowd_at_largest_scale(progress);
    const double full_scale = std::sqrt(static_cast<double>(settings_.width) * settings_.height / area_);
    const double start = std::min(full_scale * std::sqrt(0.6), scale_that_fills(0.75));
    const std::vector<std::vector<FoundPlan>> found =
        searched(PackSearch::Aim::raise_scale, start, part_of(progress, 0, 0.8));
    return best_of(
        found, [&](const std::vector<FoundPlan>& plans) { return best_at_texels(plans); }, progress,
        [](const Packing& a, const Packing& b) { return a.texels_per_unit > b.texels_per_unit; });
  }

  /// Finds a packing of the least height for the given width and scale.
  std::optional<Packing> at_given_scale(const ProgressFunction& progress) {
    set_size(settings_.width, static_cast<int>(1.4 * texel_area() / settings_.width) + 2 * settings_.gutter + 1);
    if (crowd()) return crowd_at_given_scale();
    const std::vector<std::vector<FoundPlan>> found =
        searched(PackSearch::Aim::lower_height, settings_.texels_per_unit, part_of(progress, 0, 0.8));
    return best_of(
        found, [&](const std::vector<FoundPlan>& plans) { return best_at_texels_and_scale(plans); }, progress,
        [](const Packing& a, const Packing& b) { return a.height < b.height; });
  }

  /// Finds the smallest square at the given scale.
  std::optional<Packing> in_smallest_square(const ProgressFunction& progress) {
    const int step = settings_.size_multiple;
    const auto rounded = [&](double size) { return step * static_cast<int>(std::ceil(size / step)); };
    constexpr int most_tries = 10;
    int side = rounded(std::sqrt(texel_area() / 0.7) + 2 * settings_.gutter), too_small = 0;
    std::optional<Packing> best;
    for (int tries = 0; tries < most_tries || (!best && tries < 2 * most_tries); ++tries) {
      settings_.width = side;
      std::optional<Packing> packing =
          at_given_scale([&](double fraction) { progress(std::min(1.0, (tries + fraction) / most_tries)); });
      const int height = packing ? packing->height : 2 * side;
      if (height <= side) {
        best = std::move(packing);
        best->height = side;
      } else {
        too_small = side;
      }
      side = rounded(std::clamp(0.5 * (side + height), 0.75 * side, 1.5 * side));
      if (best && side >= best->width) side = best->width - step;
      if (side <= too_small) side = too_small + step;
      if (best && side >= best->width) break;
    }
    return best;
  }

 private:
  void set_size(int width, int height) {
    settings_.width = width;
    settings_.height = height;
    // Allow for the rounding of uvs to 16 bits, and for that of the rasteriser.
    if (find_slack_) settings_.slack = std::max(width, height) / 65535.0 + 1.0 / 1024;
  }

  double texel_area() const { return area_ * settings_.texels_per_unit * settings_.texels_per_unit; }
  /// Tells whether there are so many charts that little depends on the order: they are put down once, the largest
  /// first.
  bool crowd() const { return pieces_.size() > 200; }

  std::size_t chain_count() const { return pieces_.size() == 1 ? 1 : settings_.thorough ? 16 : 4; }

  SearchBounds bounds() const {
    const int count = static_cast<int>(pieces_.size());
    if (count == 1) return {1'000'000'000, 0};  // one chart: there is no order to find, only a scale
    const std::int64_t work = std::int64_t{440'000} * std::clamp(settings_.rotations, 2, 64);
    return {settings_.thorough ? 4 * work : work, 30 * count * count};
  }

  /// Returns the number of angles tried; with many charts, half of the chains try fewer angles, and more orders
  /// instead.
  int search_rotations(std::size_t chain) const {
    const std::size_t count = pieces_.size();
    return std::min(settings_.rotations, count <= 24 || (chain + chain / 2) % 2 == 0 ? settings_.rotations : 8);
  }

  /// Returns the scale at which the charts' rectangles, each half a gutter larger to all sides, would have `share` of
  /// the room inside the atlas's border, if they were as full as their charts. Not positive where gutters alone take
  /// more.
  double scale_that_fills(double share) const {
    double perimeter = 0;
    for (const Piece& piece : pieces_) perimeter += piece.perimeter;
    const double gutter = settings_.gutter;
    const double room = share * (settings_.width - gutter) * (settings_.height - gutter);
    // area * scale^2 + perimeter / 2 * gutter * scale + count * gutter^2 = room
    const double half = 0.25 * perimeter * gutter;
    const double left = room - static_cast<double>(pieces_.size()) * gutter * gutter;
    return left > 0 ? left / (half + std::sqrt(half * half + area_ * left)) : 0;
  }

  /// Runs the chains of a search; returns what each found, the best first.
  std::vector<std::vector<FoundPlan>> searched(PackSearch::Aim aim, double texels_per_unit,
                                               const ProgressFunction& progress) const {
    const PackGrid grid = grid_of(settings_, coarse_zoom());
    std::vector<std::unique_ptr<PackSearch>> chains(chain_count());
    constexpr int slices = 20;  // progress is reported between slices
    for (int slice = 0; slice <= slices; ++slice) {
      parallel_for(std::size_t{0}, chains.size(), [&](std::size_t i) {
        if (slice == 0) {
          chains[i] = std::make_unique<PackSearch>(pieces_, grid, angles(search_rotations(i)),
                                                   settings_.seed * 1000 + i, bounds());
          chains[i]->start(aim, start_plan(i), texels_per_unit);
        }
        chains[i]->advance(static_cast<double>(slice) / slices);
      });
      progress(static_cast<double>(slice) / slices);
    }
    std::vector<std::vector<FoundPlan>> found;
    for (const auto& chain : chains)
      if (std::vector<FoundPlan> plans = chain->found(); !plans.empty()) found.push_back(std::move(plans));
    return found;
  }

  /// Returns the best of the packings that plans give in texels.
  template <typename PlacePlanInTexels, typename Better>
  std::optional<Packing> best_of(const std::vector<std::vector<FoundPlan>>& found, const PlacePlanInTexels& place,
                                 const ProgressFunction& progress, const Better& better) const {
    std::vector<std::optional<Packing>> packings(found.size());
    parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) { packings[i] = place(found[i]); });
    progress(1);
    std::optional<Packing> best;
    for (std::optional<Packing>& packing : packings)
      if (packing && (!best || better(*packing, *best))) best = std::move(packing);
    return best;
  }

  /// Returns the zoom of the coarse grid: less than 1 where searching at fewer texels saves time.
  double coarse_zoom() const {
    double zoom = 320.0 / std::sqrt(static_cast<double>(settings_.width) * settings_.height);
    // Small charts must stay more than dots.
    const double chart_texels = 0.6 * settings_.width * settings_.height / static_cast<double>(pieces_.size());
    zoom = std::max(zoom, 16 / std::sqrt(chart_texels));
    return zoom < 0.75 ? zoom : 1;
  }

  Angles angles(int rotations) const {
    Angles angles(pieces_.size());
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (int rotation = 0; rotation < rotations; ++rotation)
        angles[i].push_back(pieces_[i].base_angle + 2 * std::numbers::pi * rotation / rotations);
    return angles;
  }

  /// Makes a first plan, large charts first; the measure of size depends on the chain.
  PlacePlan start_plan(std::size_t chain) const {
    PlacePlan plan;
    plan.order.resize(pieces_.size());
    std::iota(plan.order.begin(), plan.order.end(), 0u);
    const auto size = [&](std::uint32_t i) { return chain % 2 == 0 ? pieces_[i].extent : std::sqrt(pieces_[i].area); };
    std::stable_sort(plan.order.begin(), plan.order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return size(a) > size(b); });
    plan.objectives.assign(pieces_.size(), chain / 2 % 2 == 0 ? Objective::top : Objective::middle);
    plan.rotations.assign(pieces_.size(), PlacePlan::any_rotation);
    return plan;
  }

  /// Places plans in texels, where charts may land elsewhere and the best plan may no longer be the best: others are
  /// tried at a scale a little larger than the best so far.
  std::optional<Packing> best_at_texels(const std::vector<FoundPlan>& plans) const {
    constexpr double little = 1.003;
    std::optional<Packing> best = at_texels(plans[0], 0);
    for (std::size_t i = 1; best && i < plans.size(); ++i)
      if (std::optional<Packing> other = at_texels(plans[i], little * best->texels_per_unit)) best = std::move(other);
    return best;
  }

  /// Places the same order and angles in texels, at the largest scale that fits, if that is at least `least_scale`.
  std::optional<Packing> at_texels(const FoundPlan& found, double least_scale) const {
    Angles angles;
    for (const double angle : found.angles) angles.push_back({angle});
    PlacePlan plan = found.plan;
    plan.rotations.assign(pieces_.size(), 0);
    const PackGrid grid = grid_of(settings_, 1);
    std::optional<Packing> best;
    const auto fits = [&](double scale) {
      const std::vector<Shape> shapes = rasterise(pieces_, grid, angles, scale);
      Placer placer(shapes, grid.width, grid.height, grid.gutter, Placer::Use::once);
      if (!placer.place(plan, 0, grid.height).fits()) return false;
      best = packing(shapes, placer.spots(), scale);
      return true;
    };
    // Step 1: find a scale that fits and one that does not.
    double lower = least_scale > 0 ? least_scale : found.texels_per_unit, upper = lower;
    if (fits(lower)) {
      for (int i = 0; i < 8 && fits(upper = lower * 1.008); ++i) lower = upper;
    } else if (least_scale > 0) {
      return {};
    } else {
      for (double step = 0.008; !fits(lower = upper * (1 - step)); step = std::min(0.5, 1.5 * step)) {
        upper = lower;
        if (step == 0.5 && upper < 1e-3 * found.texels_per_unit) return {};
      }
    }
    // Step 2: bisect between them, as far as fitting is monotone.
    for (int i = 0; i < 3; ++i) {
      const double middle = 0.5 * (lower + upper);
      (fits(middle) ? lower : upper) = middle;
    }
    return best;
  }

  std::optional<Packing> best_at_texels_and_scale(const std::vector<FoundPlan>& plans) const {
    std::optional<Packing> best;
    for (const FoundPlan& plan : plans)
      if (std::optional<Packing> other = at_texels_and_scale(plan); other && (!best || other->height < best->height))
        best = std::move(other);
    return best;
  }

  /// Places the same order and angles in texels, at the same scale.
  std::optional<Packing> at_texels_and_scale(const FoundPlan& found) const {
    Angles angles;
    for (const double angle : found.angles) angles.push_back({angle});
    FoundPlan fixed = found;
    fixed.plan.rotations.assign(pieces_.size(), 0);
    return at_texels_and_scale(fixed, angles);
  }

  std::optional<Packing> at_texels_and_scale(const FoundPlan& found, const Angles& angles) const {
    const PackGrid grid = grid_of(settings_, 1);
    const std::vector<Shape> shapes = rasterise(pieces_, grid, angles, found.texels_per_unit);
    for (double room = 1.1 * found.height + 2 * grid.gutter + 16; room < 3 * found.height + 256; room *= 1.5) {
      Placer placer(shapes, grid.width, static_cast<int>(room), grid.gutter,
                    crowd() ? Placer::Use::crowd : Placer::Use::once);
      const Placer::Height height = placer.place(found.plan, 0, static_cast<int>(room));
      if (!height.fits()) continue;
      Packing result = packing(shapes, placer.spots(), found.texels_per_unit);
      const int step = settings_.size_multiple;
      result.height = (height.top + grid.gutter + step - 1) / step * step;
      return result;
    }
    return {};
  }

  /// Packs a crowd at the largest scale: by regula falsi, as far as a packing is as full at one scale as at another.
  std::optional<Packing> crowd_at_largest_scale(const ProgressFunction& progress) const {
    const PackGrid grid = grid_of(settings_, 1);
    const auto count = static_cast<double>(pieces_.size());
    const double gutter = settings_.gutter;
    const double room = (settings_.width - gutter) * (settings_.height - gutter);
    if (count * (1 + gutter) * (1 + gutter) > room) return {};
    const Angles few_angles = angles(crowd_rotations());
    const PlacePlan plan = start_plan(0);
    std::optional<Packing> best;
    double lower = 0, upper = std::numeric_limits<double>::infinity();
    double scale = scale_that_fills(0.75);
    if (!(scale > 0)) scale = 0.1 * std::sqrt(room / area_);
    constexpr int most_tries = 24, usual_tries = 8;
    for (int tries = 0; tries < (best ? usual_tries : most_tries) && upper > 1.005 * lower; ++tries) {
      const std::vector<Shape> shapes = rasterise(pieces_, grid, few_angles, scale);
      Placer placer(shapes, grid.width, 2 * grid.height, grid.gutter, Placer::Use::crowd);
      const Placer::Height height = placer.place(plan, 0, std::numeric_limits<int>::max());
      const bool fits = height.fits() && height.top <= grid.top_row();
      if (fits) best = packing(shapes, placer.spots(), scale);
      (fits ? lower : upper) = scale;
      progress(std::min(1.0, (tries + 1.0) / usual_tries));
      const double next = height.fits() ? scale * scale_that_fills(1) /
                                              scale_that_fills(static_cast<double>(height.top) / grid.top_row())
                                        : 0.7 * scale;
      scale = next;
      if (lower == 0)
        scale = std::clamp(next, 0.3 * upper, 0.99 * upper);
      else if (std::isinf(upper))
        scale = std::clamp(next, 1.003 * lower, 2 * lower);
      else if (!(next > lower + 0.1 * (upper - lower) && next < upper - 0.1 * (upper - lower)))
        scale = 0.5 * (lower + upper);
    }
    progress(1);
    return best;
  }

  std::optional<Packing> crowd_at_given_scale() const {
    FoundPlan plan{settings_.texels_per_unit, 1.4 * texel_area() / settings_.width, start_plan(0), {}};
    return at_texels_and_scale(plan, angles(crowd_rotations()));
  }

  int crowd_rotations() const {
    const std::size_t count = pieces_.size();
    return std::min(settings_.rotations, count > 20'000 ? 1 : count > 4'000 ? 2 : settings_.thorough ? 8 : 4);
  }

  Packing packing(const std::vector<Shape>& shapes, const std::vector<Spot>& spots, double texels_per_unit) const {
    Packing result{settings_.width, settings_.height, texels_per_unit, {}};
    for (std::size_t i = 0; i < shapes.size(); ++i) {
      const ChartBitmap& bitmap = shapes[i][spots[i].rotation];
      result.placements.push_back({bitmap.angle, Eigen::Vector2d(spots[i].x, spots[i].y) - bitmap.origin});
    }
    return result;
  }

  PackSettings settings_;
  const bool find_slack_;
  std::vector<Piece> pieces_;
  double area_ = 0;
};

/// Turns a packing by 90 degrees clockwise.
Packing lying(Packing packing) {
  for (ChartPlacement& placement : packing.placements) {
    placement.angle -= 0.5 * std::numbers::pi;
    placement.offset = Eigen::Vector2d(placement.offset.y(), packing.width - placement.offset.x());
  }
  std::swap(packing.width, packing.height);
  return packing;
}

}  // namespace

Packing pack_charts(const std::vector<Chart>& charts, const PackSettings& settings, const ProgressFunction& progress) {
  if (charts.empty()) return {settings.width, settings.height, settings.texels_per_unit, {}};
  if (settings.texels_per_unit > 0) {
    Packer packer(charts, settings);
    std::optional<Packing> packing =
        settings.width == 0 ? packer.in_smallest_square(progress) : packer.at_given_scale(progress);
    if (packing && settings.width > 0 && settings.height > 0) {
      if (packing->height > settings.height)
        packing.reset();
      else
        packing->height = settings.height;
    }
    if (!packing)
      throw WrongUsage(
          "charts at " + fmt::format("{:g}", settings.texels_per_unit) +
          " texels per unit of length find no room in such an atlas; choose fewer texels or a larger atlas");
    return *packing;
  }
  // Stack charts along the longer side: the uneven top of the last ones wastes least there.
  const bool lies = settings.width > settings.height;
  PackSettings upright = settings;
  if (lies) std::swap(upright.width, upright.height);
  std::optional<Packing> packing = Packer(charts, upright).at_largest_scale(progress);
  if (!packing)
    throw WrongUsage("an atlas of " + std::to_string(settings.width) + " x " + std::to_string(settings.height) +
                     " texels is too small for " + std::to_string(charts.size()) + " charts with a gutter of " +
                     std::to_string(settings.gutter) + "; choose a larger --size or a smaller --gutter");
  return lies ? lying(std::move(*packing)) : *packing;
}

}  // namespace kiln
