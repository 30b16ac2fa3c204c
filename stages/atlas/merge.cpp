// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/merge.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <numeric>
#include <optional>
#include <queue>

#include "atlas/relax.h"
#include "atlas/stretch.h"
#include "base/parallel.h"
#include "mesh/disjoint_sets.h"

namespace kiln {

namespace {

/// Returns the place of a face in a chart, whose faces ascend.
std::uint32_t slot_of(const Chart& chart, std::uint32_t face) {
  return static_cast<std::uint32_t>(std::lower_bound(chart.faces.begin(), chart.faces.end(), face) -
                                    chart.faces.begin());
}

std::uint32_t local_origin(const Chart& chart, std::uint32_t h) {
  return chart.triangles[slot_of(chart, h / 3)][h % 3];
}
std::uint32_t local_target(const Chart& chart, std::uint32_t h) {
  return chart.triangles[slot_of(chart, h / 3)][(h % 3 + 1) % 3];
}

/// Pairs of a vertex of one chart and the vertex of the other (or the same) that it is glued to.
using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

Pairs vertex_pairs(const Disks& disks, const Disks::Run& run, const Chart& here, const Chart& there) {
  Pairs pairs;
  for (std::uint32_t h = run.first;; h = disks.next(h)) {
    const std::uint32_t twin = disks.surface().twins[h];
    pairs.emplace_back(local_origin(here, h), local_target(there, twin));
    pairs.emplace_back(local_target(here, h), local_origin(there, twin));
    if (h == run.last) return pairs;
  }
}

/// Turns and moves the uvs of `there` so that paired vertices come together as closely as possible.
std::vector<Eigen::Vector2d> aligned_uvs(const Chart& here, const Chart& there, const Pairs& pairs) {
  Eigen::Vector2d mean_here = Eigen::Vector2d::Zero(), mean_there = Eigen::Vector2d::Zero();
  for (const auto& [a, b] : pairs) {
    mean_here += here.uvs[a] / static_cast<double>(pairs.size());
    mean_there += there.uvs[b] / static_cast<double>(pairs.size());
  }
  std::complex<double> turn = 0;
  for (const auto& [a, b] : pairs) {
    const Eigen::Vector2d p = here.uvs[a] - mean_here, q = there.uvs[b] - mean_there;
    turn += std::complex(p.x(), p.y()) * std::conj(std::complex(q.x(), q.y()));
  }
  turn = std::abs(turn) > 0 ? turn / std::abs(turn) : 1;
  Eigen::Matrix2d rotation;
  rotation << turn.real(), -turn.imag(), turn.imag(), turn.real();
  std::vector<Eigen::Vector2d> result;
  for (const Eigen::Vector2d& uv : there.uvs) result.emplace_back(mean_here + rotation * (uv - mean_there));
  return result;
}

/// Keeps one vertex of each class, with the mean of their uvs, and sorts the faces. Replaces the vertices `tracked` by
/// their new numbers.
Chart compact(Chart chart, DisjointSets& classes, std::vector<std::uint32_t>* tracked = nullptr) {
  std::vector<std::uint32_t> new_index(chart.vertices.size(), no_index);
  Chart result;
  std::vector<double> members;
  for (std::uint32_t v = 0; v < chart.vertices.size(); ++v) {
    std::uint32_t& index = new_index[classes.root(v)];  // the root is the least of its class, so it is met first
    if (index == no_index) {
      index = static_cast<std::uint32_t>(result.vertices.size());
      result.vertices.push_back(chart.vertices[v]);
      if (!chart.uvs.empty()) result.uvs.emplace_back(Eigen::Vector2d::Zero());
      members.push_back(0);
    }
    if (!chart.uvs.empty()) result.uvs[index] += chart.uvs[v];
    members[index] += 1;
  }
  for (std::size_t v = 0; v < result.uvs.size(); ++v) result.uvs[v] /= members[v];

  std::vector<std::uint32_t> order(chart.faces.size());
  std::iota(order.begin(), order.end(), 0u);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return chart.faces[a] < chart.faces[b]; });
  for (const std::uint32_t i : order) {
    result.faces.push_back(chart.faces[i]);
    Triangle t = chart.triangles[i];
    for (std::uint32_t& corner : t) corner = new_index[classes.root(corner)];
    result.triangles.push_back(t);
  }
  if (tracked != nullptr)
    for (std::uint32_t& v : *tracked) v = new_index[classes.root(v)];
  return result;
}

/// Chart, and those of its vertices that lie on the former common border of its parts.
struct GluedChart {
  Chart chart;
  std::vector<std::uint32_t> seam;
};

/// Returns the chart that results from gluing along a run, started from the uvs of its parts.
GluedChart glued_chart(const Disks& disks, const Disks::Run& run, const Chart& here, const Chart& there) {
  const Pairs pairs = vertex_pairs(disks, run, here, there);
  Chart both = here;
  std::uint32_t offset = 0;
  if (&here != &there) {
    offset = static_cast<std::uint32_t>(here.vertices.size());
    both.faces.insert(both.faces.end(), there.faces.begin(), there.faces.end());
    both.vertices.insert(both.vertices.end(), there.vertices.begin(), there.vertices.end());
    const std::vector<Eigen::Vector2d> uvs = aligned_uvs(here, there, pairs);
    both.uvs.insert(both.uvs.end(), uvs.begin(), uvs.end());
    for (Triangle t : there.triangles) {
      for (std::uint32_t& corner : t) corner += offset;
      both.triangles.push_back(t);
    }
  }
  DisjointSets classes(both.vertices.size());
  GluedChart result;
  for (const auto& [a, b] : pairs) {
    classes.join(a, b + offset);
    result.seam.push_back(a);
  }
  result.chart = compact(std::move(both), classes, &result.seam);
  std::sort(result.seam.begin(), result.seam.end());
  result.seam.erase(std::unique(result.seam.begin(), result.seam.end()), result.seam.end());
  return result;
}

double chart_area(const Surface& surface, const Chart& chart) {
  double area = 0;
  for (const std::uint32_t face : chart.faces) area += surface.rest[face].area;
  return area;
}

/// Extents of a chart.
struct Extents {
  double largest = 0;         ///< largest extent in any direction
  double rectangle_area = 0;  ///< area of the smallest rectangle around it
  double rectangle_side = 0;  ///< longer side of that rectangle
};

/// Measures extents along 32 directions in a half-circle; between two of them an extent changes by less than 1 %.
Extents measure_extents(const Chart& chart) {
  constexpr int directions = 32;
  std::array<double, directions> along;
  for (int i = 0; i < directions; ++i) {
    const double angle = i * std::numbers::pi / directions;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    double low = std::numeric_limits<double>::infinity(), high = -low;
    for (const Eigen::Vector2d& uv : chart.uvs) {
      low = std::min(low, direction.dot(uv));
      high = std::max(high, direction.dot(uv));
    }
    along[i] = high - low;
  }
  Extents extents;
  extents.rectangle_area = std::numeric_limits<double>::infinity();
  for (int i = 0; i < directions; ++i) {
    const double across = along[(i + directions / 2) % directions];
    extents.largest = std::max(extents.largest, along[i]);
    if (along[i] * across >= extents.rectangle_area) continue;
    extents.rectangle_area = along[i] * across;
    extents.rectangle_side = std::max(along[i], across);
  }
  return extents;
}

/// Tells whether a merged chart packs well enough: small, compact, or about a rectangle that is not too long.
bool packs_well(const Surface& surface, const Chart& chart, const ChartSettings& settings) {
  const Extents extents = measure_extents(chart);
  const double area = chart_area(surface, chart), side = std::sqrt(surface.area);
  if (extents.rectangle_area > settings.largest_width * side * extents.rectangle_side) return false;
  const bool small = extents.largest <= settings.largest_extent * side;
  const bool compact_shape = extents.largest < 1.5 * std::sqrt(area);  // 1.41 is a square's diagonal
  const bool rectangle = area > 0.85 * extents.rectangle_area && extents.rectangle_side < 1.1 * side;
  return small || compact_shape || rectangle;
}

bool within_bounds(const Surface& surface, const Chart& chart, const ChartSettings& settings, double excess = 1) {
  const Stretch stretch = measure_stretch(surface, chart);
  return stretch.l2 - 1 <= excess * (settings.largest_l2 - 1) &&
         stretch.linf - 1 <= excess * (settings.largest_linf - 1);
}

/// Predicts whether relaxing may still bring a chart within the bounds, as far as its energy tells.
class Prospect {
 public:
  /// Sets the largest excess of energy. For singular values 1 + e the excess is 4 e^2 to second order, summed over
  /// both; the excess of the L2 stretch of a chart of equal area is an eighth to a quarter of that ([Sander 2001],
  /// section 3, expanded).
  explicit Prospect(const ChartSettings& settings) : most_(8 * (settings.largest_l2 - 1)) {}

  bool stepped() const { return steps_ > 0; }

  /// Takes the energy before the first step and after each; false where going on is hopeless.
  bool hopeful(double energy) {
    constexpr int most_steps = 8;
    constexpr double isometry = 4;
    const double excess = energy - isometry, fall = last_excess_ - excess;
    last_excess_ = excess;
    if (steps_++ == 0) return true;
    if (steps_ > most_steps) return false;
    // Steps gain ever less: the first one most of what there is, later ones half of the one before or less.
    return steps_ == 2 ? excess < 5 * most_ : fall > 1e-2 * excess && excess - 2 * fall < most_;
  }

 private:
  double most_, last_excess_ = 0;
  int steps_ = 0;
};

/// Returns the relaxed chart, if it is valid and within the bounds.
std::optional<Chart> flattened(const Surface& surface, GluedChart glued, const ChartSettings& settings) {
  constexpr std::size_t largest_relaxed_whole = 4000;  // faces
  Chart& chart = glued.chart;
  if (chart.faces.size() <= largest_relaxed_whole) {
    // The final charts are relaxed once more: here one step, and being within the bounds, are enough.
    Prospect prospect(settings);
    bool within = false;
    const auto goes_on = [&](double energy) {
      equalise_area(surface, chart);
      within = within_bounds(surface, chart, settings);
      return (!within || !prospect.stepped()) && prospect.hopeful(energy);
    };
    if (!relax_until(surface, chart, goes_on) || !within) return {};
  } else {
    // At first, only the surroundings of the seam have something to gain.
    const std::size_t most_faces = std::max(largest_relaxed_whole, 16 * glued.seam.size());
    if (!relax_around(surface, chart, glued.seam, most_faces, {8, 1e-2})) return {};
    equalise_area(surface, chart);
    if (!within_bounds(surface, chart, settings)) {
      if (!within_bounds(surface, chart, settings, 1.5) || !is_flip_free(chart)) return {};
      relax(surface, chart, {3, 1e-2});
      equalise_area(surface, chart);
    }
  }
  if (!within_bounds(surface, chart, settings) || !is_flip_free(chart)) return {};
  if (!has_simple_border(chart) || !keeps_clear(surface, chart, settings.clearance) ||
      !packs_well(surface, chart, settings))
    return {};
  return std::move(chart);
}

struct MergeCandidate {
  double score;
  std::uint32_t half_edge;
  std::uint32_t version_here, version_there;

  bool operator<(const MergeCandidate& other) const {  // the queue's top is the largest: the best score
    return score != other.score ? score < other.score : half_edge > other.half_edge;
  }
};

class Merger {
 public:
  Merger(Disks& disks, std::vector<Chart>& charts, const ChartSettings& settings)
      : disks_(disks), charts_(charts), settings_(settings) {}

  void run(const ProgressFunction& progress) {
    const std::vector<std::uint32_t> ids = disks_.ids();
    for (const std::uint32_t id : ids) push_runs(id, false);
    double most_left = 1;
    while (!queue_.empty()) {
      most_left = std::max(most_left, static_cast<double>(queue_.size()));
      progress(1 - static_cast<double>(queue_.size()) / most_left);
      try_batch();
    }
  }

 private:
  /// Takes the best candidates that share no chart, tries them in parallel and glues those that succeed. The size of
  /// the batch does not depend on the number of threads, so neither does the result.
  void try_batch() {
    constexpr std::size_t batch_size = 8;
    struct Trial {
      MergeCandidate candidate;
      Disks::Run run;
      std::uint32_t here, there;
      std::optional<Chart> result;
    };
    std::vector<Trial> trials;
    std::vector<MergeCandidate> later;
    while (!queue_.empty() && trials.size() < batch_size && later.size() < batch_size) {
      const MergeCandidate candidate = queue_.top();
      queue_.pop();
      const std::uint32_t h = candidate.half_edge;
      if (!disks_.on_border(h)) continue;
      const std::uint32_t here = disks_.disk_of(h), there = disks_.disk_of(disks_.surface().twins[h]);
      if (disks_.disk(here).version != candidate.version_here || disks_.disk(there).version != candidate.version_there)
        continue;
      const bool taken = std::any_of(trials.begin(), trials.end(), [&](const Trial& t) {
        return t.here == here || t.here == there || t.there == here || t.there == there;
      });
      if (taken)
        later.push_back(candidate);
      else
        trials.push_back({candidate, disks_.run_through(h), here, there, {}});
    }
    parallel_for(std::size_t{0}, trials.size(), [&](std::size_t i) {
      Trial& t = trials[i];
      t.result = flattened(disks_.surface(), glued_chart(disks_, t.run, charts_[t.here], charts_[t.there]), settings_);
    });
    for (const MergeCandidate& candidate : later) queue_.push(candidate);
    for (Trial& t : trials) {
      if (!t.result) continue;
      const std::uint32_t id = disks_.glue(t.run);
      charts_[id == t.here ? t.there : t.here] = Chart{};
      charts_[id] = std::move(*t.result);
      push_runs(id, true);
    }
  }

  /// Queues the best run to each neighbour, and every slit's end.
  void push_runs(std::uint32_t id, bool to_all) {
    std::uint32_t start = no_index;
    for (const std::uint32_t face : disks_.disk(id).faces) {
      for (std::uint32_t k = 0; k < 3 && start == no_index; ++k)
        if (disks_.on_border(3 * face + k)) start = 3 * face + k;
      if (start != no_index) break;
    }
    // Walk run by run, from a run's first edge on.
    if (disks_.run_through(start).possible()) start = disks_.run_through(start).first;
    std::vector<std::pair<std::uint32_t, MergeCandidate>> best;
    std::uint32_t h = start;
    do {
      const std::uint32_t twin = disks_.surface().twins[h];
      if (twin != no_index) {
        const Disks::Run run = disks_.run_through(h);
        if (run.possible()) {
          consider(id, disks_.disk_of(twin), run, best);
          while (h != run.last && disks_.next(h) != start) h = disks_.next(h);
        }
      }
      h = disks_.next(h);
    } while (h != start);
    for (const auto& [neighbour, candidate] : best)
      if (to_all || id <= neighbour) queue_.push(candidate);
  }

  void consider(std::uint32_t here, std::uint32_t there, const Disks::Run& run,
                std::vector<std::pair<std::uint32_t, MergeCandidate>>& best) const {
    if (run.bend > settings_.crease_degrees * std::numbers::pi / 180) return;
    const Disks::Disk &a = disks_.disk(here), &b = disks_.disk(there);
    // Score: the share of a chart's border that would no longer be a seam, weighted by its visibility.
    const double share = run.length / std::min(a.perimeter, b.perimeter);
    if (share < 0.1 && here != there) return;
    const double score = run.cost / std::min(a.perimeter, b.perimeter);
    const MergeCandidate candidate{score, run.first, a.version, b.version};
    const auto known = std::find_if(best.begin(), best.end(), [&](const auto& entry) { return entry.first == there; });
    if (known == best.end())
      best.emplace_back(there, candidate);
    else if (known->second < candidate)
      known->second = candidate;
  }

  Disks& disks_;
  std::vector<Chart>& charts_;
  const ChartSettings& settings_;
  std::priority_queue<MergeCandidate> queue_;
};

}  // namespace

Chart chart_of_disk(const Disks& disks, std::uint32_t id) {
  const Surface& surface = disks.surface();
  Chart chart;
  chart.faces = disks.disk(id).faces;
  std::sort(chart.faces.begin(), chart.faces.end());
  // Every corner starts as a vertex of its own, until glued edges join some of them.
  for (std::uint32_t i = 0; i < chart.faces.size(); ++i) {
    const Triangle& t = surface.mesh->triangles[chart.faces[i]];
    chart.vertices.insert(chart.vertices.end(), t.begin(), t.end());
    chart.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  DisjointSets classes(chart.vertices.size());
  for (const std::uint32_t face : chart.faces)
    for (std::uint32_t h = 3 * face; h < 3 * face + 3; ++h) {
      if (disks.on_border(h)) continue;
      const std::uint32_t twin = surface.twins[h];
      classes.join(local_origin(chart, h), local_target(chart, twin));
      classes.join(local_target(chart, h), local_origin(chart, twin));
    }
  return compact(std::move(chart), classes);
}

void merge_charts(Disks& disks, std::vector<Chart>& charts, const ChartSettings& settings,
                  const ProgressFunction& progress) {
  Merger(disks, charts, settings).run(progress);
}

}  // namespace kiln
