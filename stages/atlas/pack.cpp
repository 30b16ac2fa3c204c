// The search is one over orders in which charts are put down, bottom left first (Baker, Coffman and Rivest 1980; with
// turned bitmaps as in Levy et al. 2002, section 4): simulated annealing at a resolution at which a packing takes less
// than a millisecond; what it finds is then placed at the resolution of the texels.
#include "atlas/pack.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <random>
#include <tbb/parallel_for.h>

#include "atlas/place.h"
#include "base/errors.h"

namespace kiln {

namespace {

/// The angle that lays a chart's smallest enclosing rectangle along the axes. One side of it lies along an edge of the
/// convex hull; trying evenly spread angles instead is as good as can be told after rasterising.
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

/// What packing needs to know of a chart.
struct Piece {
  ChartOutline outline;
  double area = 0;
  double extent = 0;  ///< longer side of its smallest rectangle
  double base_angle = 0;
};

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
  return piece;
}

/// The atlas at some resolution. Below that of the texels each piece is drawn half a gutter larger to all sides.
struct Grid {
  double zoom = 1;  ///< grid texels per texel
  int width = 0;
  int height = 0;  ///< that charts should keep to
  int gutter = 0;
  BitmapSettings bitmap;
};

Grid grid_of(const PackSettings& settings, double zoom) {
  Grid grid;
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

using Angles = std::vector<std::vector<double>>;  ///< per piece, those to be tried

std::vector<Shape> rasterise(const std::vector<Piece>& pieces, const Grid& grid, const Angles& angles,
                             double texels_per_unit) {
  std::vector<Shape> shapes(pieces.size());
  tbb::parallel_for(std::size_t{0}, pieces.size(), [&](std::size_t i) {
    for (const double angle : angles[i]) {
      BitmapSettings bitmap = grid.bitmap;
      bitmap.texels_per_unit = texels_per_unit * grid.zoom;
      bitmap.angle = angle;
      shapes[i].push_back(rasterise_chart(pieces[i].outline, bitmap));
    }
  });
  return shapes;
}

/// A way to put pieces down that fitted.
struct Found {
  double texels_per_unit = 0;
  double height = std::numeric_limits<double>::infinity();  ///< used, texels
  PlacePlan plan;
  std::vector<double> angles;  ///< per piece
};

/// Looks for better orders by small changes, at one resolution.
class Search {
 public:
  Search(const std::vector<Piece>& pieces, const Grid& grid, Angles angles, std::uint64_t seed)
      : pieces_(pieces), grid_(grid), angles_(std::move(angles)), random_(seed) {
    for (std::size_t i = 0; i < pieces.size(); ++i)
      work_per_scale_ += static_cast<std::int64_t>(4 * pieces[i].outline.size() * angles_[i].size());
  }

  /// Raises the scale from `texels_per_unit`, which may be too large, as long as the plan can be changed to fit the
  /// grid's height. The best that fitted, if any did.
  std::optional<Found> raise_scale(PlacePlan plan, double texels_per_unit, std::int64_t most_work) {
    plan_ = std::move(plan);
    std::optional<Found> best;
    for (int shrinks = 0; !set_scale(texels_per_unit, 3 * grid_.height / 2); ++shrinks) {
      if (shrinks == 60) return {};
      texels_per_unit *= 0.85;
    }
    for (int shrinks = 0; height_.top > top_row(); ++shrinks) {
      if (shrinks == 60) return {};
      texels_per_unit *= std::min(0.995, std::sqrt(static_cast<double>(top_row()) / height_.top));
      if (!set_scale(texels_per_unit, 3 * grid_.height / 2)) height_.top = 2 * grid_.height;
    }
    while (work() < most_work) {
      if (height_.top <= top_row()) {
        best = found(texels_per_unit);
        texels_per_unit *= std::clamp(std::sqrt(static_cast<double>(top_row()) / height_.top), 1.003, 1.05);
        if (!set_scale(texels_per_unit, 3 * grid_.height / 2)) break;
      } else {
        change(1 - static_cast<double>(work()) / static_cast<double>(most_work));
      }
    }
    if (height_.top <= top_row()) best = found(texels_per_unit);
    return best;
  }

  /// Lowers the height at a given scale.
  std::optional<Found> lower_height(PlacePlan plan, double texels_per_unit, std::int64_t most_work) {
    plan_ = std::move(plan);
    double area = 0, extents = 0;
    for (const Piece& piece : pieces_) {
      area += piece.area;
      extents = std::max(extents, piece.extent);
    }
    const double scale = texels_per_unit * grid_.zoom;
    double room = 3 * area * scale * scale / grid_.width + extents * scale + 64;
    for (int tries = 0; !set_scale(texels_per_unit, static_cast<int>(std::min(room, 1e6))); room *= 2)
      if (++tries == 8) return {};
    Found best = found(texels_per_unit);
    while (work() < most_work) {
      change(1 - static_cast<double>(work()) / static_cast<double>(most_work));
      if (height_.top / grid_.zoom < best.height) best = found(texels_per_unit);
    }
    return best;
  }

 private:
  int top_row() const { return grid_.height - grid_.gutter; }
  std::int64_t work() const { return work_ + (placer_ ? placer_->work() : 0); }
  double chance() { return static_cast<double>(random_() >> 11) * 0x1p-53; }  // the same on every platform
  std::size_t pick(std::size_t count) { return static_cast<std::size_t>(chance() * static_cast<double>(count)); }

  bool set_scale(double texels_per_unit, int room) {
    work_ = work() + work_per_scale_;
    placer_.reset();
    shapes_ = rasterise(pieces_, grid_, angles_, texels_per_unit);
    placer_.emplace(shapes_, grid_.width, room + grid_.gutter, grid_.gutter);
    height_ = placer_->place(plan_, 0, std::numeric_limits<int>::max());
    if (!height_.fits()) return false;
    placer_->keep();
    spots_ = placer_->spots();
    return true;
  }

  static double cost(const Placer::Height& height) { return height.top + 0.5 * height.middle; }

  /// Tries a change and keeps it where it is no worse, or, by chance, a little worse.
  void change(double temperature) {
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
    const double most = cost(height_) + allowed;
    ++work_;
    const Placer::Height height =
        placer_->place(plan, first, static_cast<int>(std::min(most - 0.25 * height_.middle, 1e9)));
    if (!height.fits() || cost(height) > most) return;
    placer_->keep();
    spots_ = placer_->spots();
    plan_ = std::move(plan);
    height_ = height;
  }

  Found found(double texels_per_unit) const {
    Found result{texels_per_unit, height_.top / grid_.zoom, plan_, {}};
    for (std::size_t i = 0; i < pieces_.size(); ++i) result.angles.push_back(angles_[i][spots_[i].rotation]);
    return result;
  }

  const std::vector<Piece>& pieces_;
  const Grid grid_;
  const Angles angles_;
  std::mt19937_64 random_;
  std::int64_t work_ = 0, work_per_scale_ = 0;
  std::vector<Shape> shapes_;
  std::optional<Placer> placer_;
  PlacePlan plan_;
  Placer::Height height_;
  std::vector<Spot> spots_;
};

/// Finds places in an atlas that is not wider than high, or of a given width.
class Packer {
 public:
  Packer(const std::vector<Chart>& charts, const PackSettings& settings)
      : settings_(settings), find_slack_(settings.slack == 0), pieces_(charts.size()) {
    tbb::parallel_for(std::size_t{0}, charts.size(), [&](std::size_t i) { pieces_[i] = piece_of(charts[i]); });
    for (const Piece& piece : pieces_) area_ += piece.area;
    if (settings.width > 0 && settings.height > 0) set_size(settings.width, settings.height);
  }

  /// The largest scale that fits.
  std::optional<Packing> at_largest_scale(const ProgressFunction& progress) {
    const double full_scale = std::sqrt(static_cast<double>(settings_.width) * settings_.height / area_);
    const Grid grid = grid_of(settings_, coarse_zoom());
    std::vector<std::optional<Found>> found(chain_count());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
      Search search(pieces_, grid, all_angles(), settings_.seed * 1000 + i);
      found[i] = search.raise_scale(start_plan(i), full_scale * std::sqrt(0.6), work_per_chain());
    });
    progress(0.8);
    std::vector<std::optional<Packing>> packings(found.size());
    tbb::parallel_for(std::size_t{0}, found.size(), [&](std::size_t i) {
      if (found[i]) packings[i] = at_texels(*found[i]);
    });
    std::optional<Packing> best;
    for (std::optional<Packing>& packing : packings)
      if (packing && (!best || packing->texels_per_unit > best->texels_per_unit)) best = std::move(packing);
    progress(1);
    return best;
  }

  /// The least height found for the given width and scale.
  std::optional<Packing> at_given_scale(const ProgressFunction& progress) {
    set_size(settings_.width, static_cast<int>(1.4 * texel_area() / settings_.width) + 2 * settings_.gutter + 1);
    const Grid grid = grid_of(settings_, coarse_zoom());
    std::vector<std::optional<Packing>> packings(chain_count());
    tbb::parallel_for(std::size_t{0}, packings.size(), [&](std::size_t i) {
      Search search(pieces_, grid, all_angles(), settings_.seed * 1000 + i);
      if (const auto found = search.lower_height(start_plan(i), settings_.texels_per_unit, work_per_chain()))
        packings[i] = at_texels_and_scale(*found);
    });
    progress(1);
    std::optional<Packing> best;
    for (std::optional<Packing>& packing : packings)
      if (packing && (!best || packing->height < best->height)) best = std::move(packing);
    return best;
  }

  /// The smallest square found at the given scale.
  std::optional<Packing> in_smallest_square(const ProgressFunction& progress) {
    const int step = settings_.size_multiple;
    const auto rounded = [&](double size) { return step * static_cast<int>(std::ceil(size / step)); };
    constexpr int most_tries = 10;
    int side = rounded(std::sqrt(texel_area() / 0.7) + 2 * settings_.gutter), too_small = 0;
    std::optional<Packing> best;
    for (int tries = 0; tries < most_tries || (!best && tries < 2 * most_tries); ++tries) {
      settings_.width = side;
      std::optional<Packing> packing = at_given_scale(no_progress);
      progress(static_cast<double>(tries + 1) / most_tries);
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
    // Rounding of uvs to 16 bits, and of the rasteriser.
    if (find_slack_) settings_.slack = std::max(width, height) / 65535.0 + 1.0 / 1024;
  }

  double texel_area() const { return area_ * settings_.texels_per_unit * settings_.texels_per_unit; }
  bool many() const { return pieces_.size() > 200; }  // small ones: little depends on how each is turned
  std::size_t chain_count() const { return many() ? (settings_.thorough ? 2 : 1) : (settings_.thorough ? 16 : 4); }
  std::int64_t work_per_chain() const { return settings_.thorough ? 80'000'000 : 20'000'000; }

  /// Less than 1 where searching at fewer texels saves time.
  double coarse_zoom() const {
    double zoom = 320.0 / std::max(settings_.width, settings_.height);
    // Small charts must not become mere dots.
    const double chart_texels = 0.6 * settings_.width * settings_.height / static_cast<double>(pieces_.size());
    zoom = std::max(zoom, 16 / std::sqrt(chart_texels));
    return zoom < 0.75 ? zoom : 1;
  }

  Angles all_angles() const {
    Angles angles(pieces_.size());
    const int rotations = many() ? std::min(settings_.rotations, 4) : settings_.rotations;
    for (std::size_t i = 0; i < pieces_.size(); ++i)
      for (int rotation = 0; rotation < rotations; ++rotation)
        angles[i].push_back(pieces_[i].base_angle + 2 * std::numbers::pi * rotation / rotations);
    return angles;
  }

  /// Large ones first; which are large depends on the chain.
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

  /// The same order and angles in texels, at the largest scale that does.
  std::optional<Packing> at_texels(const Found& found) const {
    Angles angles;
    for (const double angle : found.angles) angles.push_back({angle});
    PlacePlan plan = found.plan;
    plan.rotations.assign(pieces_.size(), 0);
    const Grid grid = grid_of(settings_, 1);
    std::optional<Packing> best;
    const auto fits = [&](double scale) {
      const std::vector<Shape> shapes = rasterise(pieces_, grid, angles, scale);
      Placer placer(shapes, grid.width, grid.height, grid.gutter);
      if (!placer.place(plan, 0, grid.height).fits()) return false;
      best = packing(shapes, placer.spots(), scale);
      return true;
    };
    double lower = found.texels_per_unit, upper = lower;
    if (fits(lower)) {
      for (int i = 0; i < 8 && fits(upper = lower * 1.008); ++i) lower = upper;
    } else {
      for (double step = 0.008; !fits(lower = upper * (1 - step)); step = std::min(0.5, 1.5 * step)) {
        upper = lower;
        if (step == 0.5 && upper < 1e-3 * found.texels_per_unit) return {};
      }
    }
    for (int i = 0; i < 3; ++i) {
      const double middle = 0.5 * (lower + upper);
      (fits(middle) ? lower : upper) = middle;
    }
    return best;
  }

  /// The same order and angles in texels, at the same scale.
  std::optional<Packing> at_texels_and_scale(const Found& found) const {
    Angles angles;
    for (const double angle : found.angles) angles.push_back({angle});
    PlacePlan plan = found.plan;
    plan.rotations.assign(pieces_.size(), 0);
    const Grid grid = grid_of(settings_, 1);
    const std::vector<Shape> shapes = rasterise(pieces_, grid, angles, found.texels_per_unit);
    for (double room = 1.1 * found.height + 2 * grid.gutter + 16; room < 3 * found.height + 256; room *= 1.5) {
      Placer placer(shapes, grid.width, static_cast<int>(room), grid.gutter);
      const Placer::Height height = placer.place(plan, 0, static_cast<int>(room));
      if (!height.fits()) continue;
      Packing result = packing(shapes, placer.spots(), found.texels_per_unit);
      const int step = settings_.size_multiple;
      result.height = (height.top + grid.gutter + step - 1) / step * step;
      return result;
    }
    return {};
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
  for (Placement& placement : packing.placements) {
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
          "charts at " + std::to_string(settings.texels_per_unit) +
          " texels per unit of length find no room in such an atlas; choose fewer texels or a larger atlas");
    return *packing;
  }
  // Charts are stacked along the longer side: the last ones' uneven top then wastes least.
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
