// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/charts.h"

#include <algorithm>
#include <numbers>

#include "atlas/disks.h"
#include "atlas/grow.h"
#include "atlas/merge.h"
#include "atlas/parameterise.h"
#include "base/parallel.h"

namespace kiln {

namespace {

bool keeps_bounds(const Surface& surface, const Chart& chart, const ChartSettings& settings) {
  const Stretch stretch = measure_stretch(surface, chart);
  return stretch.l2 <= settings.largest_l2 && stretch.linf <= settings.largest_linf;
}

/// Flattens every disk of the list; disks that cannot be flattened within the bounds are taken apart and grown again to
/// flatter ones. Returns the number of those.
int flatten_or_split(Disks& disks, std::vector<Chart>& charts, std::vector<std::uint32_t> ids,
                     const ChartSettings& settings, GrowSettings grow_settings) {
  int splits = 0;
  while (!ids.empty()) {
    std::vector<std::uint8_t> flat(ids.size());
    parallel_for(std::size_t{0}, ids.size(), [&](std::size_t i) {
      charts[ids[i]] = chart_of_disk(disks, ids[i]);
      flat[i] = parameterise_quickly(disks.surface(), charts[ids[i]]) &&
                keeps_bounds(disks.surface(), charts[ids[i]], settings);
    });
    std::vector<std::uint32_t> pieces;
    grow_settings.largest_spread *= 0.25;
    for (std::size_t i = 0; i < ids.size(); ++i) {
      if (flat[i]) continue;
      charts[ids[i]] = Chart{};
      const std::vector<std::uint32_t> faces = disks.disk(ids[i]).faces;
      if (faces.size() == 1) throw std::runtime_error("a single triangle cannot be flattened");
      ++splits;
      disks.dissolve(ids[i]);
      if (grow_settings.largest_spread > 1e-6) grow(disks, faces, grow_settings);
      for (const std::uint32_t face : faces)
        if (disks.exists(face)) pieces.push_back(face);
    }
    ids = std::move(pieces);
  }
  return splits;
}

}  // namespace

ChartSet cut_into_charts(const Surface& surface, const ChartSettings& settings, const ProgressFunction& progress) {
  Disks disks(surface);
  std::vector<Chart> charts(surface.face_count());
  ChartSet result;

  GrowSettings grow_settings;
  grow_settings.sharpest_bend = settings.crease_degrees * std::numbers::pi / 180;
  grow(disks, disks.ids(), grow_settings);
  progress(0.1);
  result.split_charts = flatten_or_split(disks, charts, disks.ids(), settings, grow_settings);
  progress(0.2);
  merge_charts(disks, charts, settings, part_of(progress, 0.2, 0.8));

  for (const std::uint32_t id : disks.ids()) result.charts.push_back(std::move(charts[id]));
  // Finally flatten each chart by the best of several ways, its merged uvs among them.
  std::vector<std::uint8_t> flat(result.charts.size());
  parallel_for(std::size_t{0}, flat.size(), [&](std::size_t i) {
    Chart best = result.charts[i];
    flat[i] = parameterise(surface, best);
    const auto clear = [&](const Chart& c) { return keeps_clear(surface, c, settings.clearance); };
    if (clear(best) || !clear(result.charts[i])) result.charts[i] = std::move(best);
  });
  if (std::find(flat.begin(), flat.end(), 0) != flat.end()) throw std::runtime_error("a chart lost its valid map");
  return result;
}

}  // namespace kiln
