// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/grow.h"

#include <cmath>
#include <numbers>
#include <queue>

namespace kiln {

namespace {

struct GrowthCandidate {
  double cost;
  std::uint32_t half_edge;
  std::uint32_t version_here, version_there;

  bool operator<(const GrowthCandidate& other) const {  // the queue's top is the largest: here the cheapest
    return cost != other.cost ? cost > other.cost : half_edge > other.half_edge;
  }
};

/// Returns the deviation of normals: area minus the length of the area-weighted normal.
double bending(double area, const Eigen::Vector3d& area_normal) { return area - area_normal.norm(); }

class Grower {
 public:
  Grower(Disks& disks, const GrowSettings& settings)
      : disks_(disks), settings_(settings), listed_(disks.id_count(), 0) {}

  void run(const std::vector<std::uint32_t>& ids) {
    for (const std::uint32_t id : ids) listed_[id] = 1;
    for (const std::uint32_t id : ids) push_runs(id, true);
    while (!queue_.empty()) {
      const GrowthCandidate candidate = queue_.top();
      queue_.pop();
      const std::uint32_t h = candidate.half_edge;
      if (!disks_.on_border(h)) continue;
      const std::uint32_t here = disks_.disk_of(h), there = disks_.disk_of(disks_.surface().twins[h]);
      if (here == there || disks_.disk(here).version != candidate.version_here ||
          disks_.disk(there).version != candidate.version_there)
        continue;
      push_runs(disks_.glue(disks_.run_through(h)), false);
    }
  }

 private:
  void push_runs(std::uint32_t id, bool once_per_pair) {
    const std::uint32_t start = border_start(id);
    if (start == no_index) return;
    std::uint32_t h = start;
    do {
      const std::uint32_t twin = disks_.surface().twins[h];
      if (twin != no_index && disks_.disk_of(twin) != id && listed_[disks_.disk_of(twin)] &&
          (!once_per_pair || h < twin)) {
        const Disks::Run run = disks_.run_through(h);
        if (run.possible()) push(run);
        // The rest of the run has nothing to add: skip it, up to where the walk meets its start again.
        while (run.possible() && h != run.last && disks_.next(h) != start) h = disks_.next(h);
      }
      h = disks_.next(h);
    } while (h != start);
  }

  std::uint32_t border_start(std::uint32_t id) const {
    for (const std::uint32_t face : disks_.disk(id).faces)
      for (std::uint32_t k = 0; k < 3; ++k)
        if (disks_.on_border(3 * face + k)) return 3 * face + k;
    return no_index;
  }

  void push(const Disks::Run& run) {
    if (run.bend > settings_.sharpest_bend) return;
    const Disks::Disk& a = disks_.disk(disks_.disk_of(run.first));
    const Disks::Disk& b = disks_.disk(disks_.disk_of(disks_.surface().twins[run.first]));
    const double area = a.area + b.area;
    const Eigen::Vector3d area_normal = a.area_normal + b.area_normal;
    const double together = bending(area, area_normal);
    if (together > settings_.largest_spread * area) return;
    const double perimeter = a.perimeter + b.perimeter - 2 * run.length;
    const double roundness = perimeter * perimeter / (4 * std::numbers::pi * area);
    if (roundness > 4 && 0.5 * perimeter > std::sqrt(disks_.surface().area)) return;  // too long a ribbon to pack well
    const double added = together - bending(a.area, a.area_normal) - bending(b.area, b.area_normal);
    // Between flat disks roundness alone decides, small ones first.
    const double visibility = run.length > 0 ? run.cost / run.length : 1;
    const double cost = (std::max(added, 0.0) + 1e-3 * area) * roundness / std::clamp(visibility, 0.25, 4.0);
    queue_.push({cost, run.first, a.version, b.version});
  }

  Disks& disks_;
  const GrowSettings& settings_;
  std::vector<std::uint8_t> listed_;
  std::priority_queue<GrowthCandidate> queue_;
};

}  // namespace

void grow(Disks& disks, const std::vector<std::uint32_t>& ids, const GrowSettings& settings) {
  Grower(disks, settings).run(ids);
}

}  // namespace kiln
