// SPDX-License-Identifier: GPL-3.0-or-later
#include "collapse/level_chain.h"

#include <algorithm>
#include <limits>
#include <queue>

#include "base/parallel.h"
#include "collapse/chart_outlines.h"
#include "collapse/sample_fit.h"
#include "collapse/texture_deviation.h"
#include "collapse/wedge_mesh.h"
#include "mesh/mesh_vertices.h"

namespace kiln {

namespace {

constexpr std::uint32_t no_point = ~0u;

/// Returns uvs in texels, those of each layer beside those of the one before.
std::vector<Eigen::Vector2d> outline_uvs(const TriangleMesh& mesh, const LevelLimits& limits) {
  std::vector<Eigen::Vector2d> uvs;
  uvs.reserve(mesh.uvs.size());
  double lowest = 0, highest = 0;
  for (const Eigen::Vector2f& uv : mesh.uvs) {
    uvs.emplace_back(uv.x() * limits.size.width, uv.y() * limits.size.height);
    lowest = std::min(lowest, uvs.back().x());
    highest = std::max(highest, uvs.back().x());
  }
  const double width = highest - lowest + 4 * (limits.farthest_overhang + limits.size.width);
  for (std::size_t v = 0; v < limits.layers.size(); ++v) uvs[v].x() += limits.layers[v] * width;
  return uvs;
}

/// The collapse of one atlas mesh.
class Chain {
 public:
  Chain(const TriangleMesh& atlas, const LevelLimits& limits)
      : wedges_(atlas),
        deviation_(atlas, limits.size),
        outlines_(wedges_, outline_uvs(atlas, limits), limits.overhang,
                  std::max(limits.overhang, limits.farthest_overhang)),
        best_(wedges_.point_count()),
        changes_(wedges_.point_count(), 0) {}

  int triangle_count() const { return wedges_.triangle_count(); }
  std::vector<Triangle> triangles() const { return wedges_.triangles(); }
  std::vector<PlacedSample> samples() const { return deviation_.placed_samples(wedges_); }
  const WedgeMesh& wedges() const { return wedges_; }

  /// Collapses until a goal is reached. Returns false where nothing is left to collapse before.
  bool reach(const LevelGoal& goal, const ProgressFunction& progress) {
    largest_ = goal.error > 0 ? goal.error : std::numeric_limits<double>::infinity();
    queue_ = {};
    parallel_for(std::size_t{0}, best_.size(), 64,
                 [&](std::size_t point) { best_[point] = find_best(static_cast<std::uint32_t>(point)); });
    for (std::uint32_t point = 0; point < best_.size(); ++point) enqueue(point);
    const int first = triangle_count();
    for (int step = 0; triangle_count() > goal.triangles; ++step) {
      if (queue_.empty()) return false;
      const Entry entry = queue_.top();
      queue_.pop();
      if (entry.changes != changes_[entry.point]) {
        renew(entry.point);
        continue;
      }
      if (!collapse(entry.point)) renew(entry.point);
      if (step % 256 == 0 && first > goal.triangles)
        progress(static_cast<double>(first - triangle_count()) / (first - goal.triangles));
    }
    return true;
  }

 private:
  struct Best {
    std::uint32_t to = no_point;
    double cost = 0;
    bool queued = false;
  };
  struct Entry {
    double cost = 0;
    std::uint32_t point = 0;
    std::uint32_t changes = 0;  ///< of the point when its cost was found
    bool operator<(const Entry& other) const {
      return cost != other.cost ? cost > other.cost : point > other.point;  // the top is the greatest
    }
  };

  Best find_best(std::uint32_t point) const {
    Best best;
    for (const WedgeCollapse& candidate : wedges_.collapses_of(point)) {
      const double most_cost = best.to != no_point ? best.cost : std::numeric_limits<double>::infinity();
      const DeviationChange change = deviation_.judge(wedges_, candidate, most_cost);
      if (!change.allowed || change.worst > largest_) continue;
      if (!outlines_.allow(wedges_, candidate)) continue;
      best = {candidate.to, change.cost, false};
    }
    return best;
  }

  void enqueue(std::uint32_t point) {
    Best& best = best_[point];
    best.queued = best.to != no_point;
    if (best.queued) queue_.push({best.cost, point, changes_[point]});
  }

  void renew(std::uint32_t point) {
    best_[point] = find_best(point);
    enqueue(point);
  }

  /// Collapses a point as it was found best. Returns false where that is no longer possible: what is farther away may
  /// have changed.
  bool collapse(std::uint32_t point) {
    const std::vector<WedgeCollapse> possible = wedges_.collapses_of(point);
    const auto found = std::find_if(possible.begin(), possible.end(),
                                    [&](const WedgeCollapse& candidate) { return candidate.to == best_[point].to; });
    if (found == possible.end() || !outlines_.allow(wedges_, *found)) return false;
    deviation_.apply(wedges_, *found);
    outlines_.apply(*found);
    wedges_.apply(*found);
    std::vector<std::uint32_t> concerned = wedges_.neighbours(found->to);
    concerned.push_back(found->to);
    for (const std::uint32_t near : concerned) ++changes_[near];
    // Points in the queue find their new costs when their turn comes: few costs fall.
    for (const std::uint32_t near : concerned)
      if (!best_[near].queued) renew(near);
    return true;
  }

  WedgeMesh wedges_;
  TextureDeviation deviation_;
  ChartOutlines outlines_;
  std::vector<Best> best_;              ///< by point
  std::vector<std::uint32_t> changes_;  ///< by point: how often what is around it has changed
  std::priority_queue<Entry> queue_;
  double largest_ = 0;
};

}  // namespace

std::vector<Level> make_level_chain(const TriangleMesh& atlas, const std::vector<LevelGoal>& goals,
                                    const LevelLimits& limits, const ProgressFunction& progress) {
  std::vector<Level> levels;
  Chain chain(atlas, limits);
  for (std::size_t k = 0; k < goals.size(); ++k) {
    Level& level = levels.emplace_back();
    level.reached_goal = chain.reach(goals[k], step_of(progress, k, goals.size()));
    level.mesh = with_triangles(atlas, chain.triangles(), &level.sources);
    if (limits.fits) {
      const FittedLevel fitted = fit_to_samples(chain.wedges(), atlas, chain.samples(), goals[k].error);
      for (std::size_t v = 0; v < level.sources.size(); ++v) {
        level.mesh.positions[v] = fitted.positions[level.sources[v]];
        if (!level.mesh.normals.empty()) level.mesh.normals[v] = fitted.normals[level.sources[v]];
      }
      level.deviation = fitted.deviation.largest;
      level.rms_deviation = fitted.deviation.rms;
    } else {
      const SampleDeviation deviation = deviation_of(chain.samples(), atlas.positions);
      level.deviation = deviation.largest;
      level.rms_deviation = deviation.rms;
    }
  }
  return levels;
}

}  // namespace kiln
