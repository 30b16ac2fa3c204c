// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/choose.h"

#include <array>
#include <optional>

#include "base/progress.h"

namespace kiln {

ChartSet choose_charts(const Surface& surface, const ChartSettings& charts, const PackSettings& pack,
                       const ProgressFunction& progress) {
  constexpr std::array extents{0.6, 0.45, 0.7, 0.52, 0.9};
  constexpr std::uint32_t most_faces_for_all = 100'000;  // with more, cutting takes minutes
  const std::size_t ways = surface.face_count() > most_faces_for_all ? 2 : extents.size();
  PackSettings quick = pack;
  quick.thorough = false;
  std::optional<ChartSet> best;
  double best_score = 0;
  for (std::size_t way = 0; way < ways; ++way) {
    const auto part = [&](double fraction) {
      progress((static_cast<double>(way) + fraction) / static_cast<double>(ways));
    };
    ChartSettings settings = charts;
    settings.largest_extent *= extents[way] / extents[0];
    ChartSet cut = cut_into_charts(surface, settings, [&](double fraction) { part(0.6 * fraction); });
    const Packing packing = pack_charts(cut.charts, quick, [&](double fraction) { part(0.6 + 0.4 * fraction); });
    const double score =
        packing.texels_per_unit * packing.texels_per_unit / (static_cast<double>(packing.width) * packing.height);
    if (score <= best_score) continue;
    best_score = score;
    best = std::move(cut);
  }
  return std::move(*best);
}

}  // namespace kiln
