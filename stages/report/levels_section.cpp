// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/levels_section.h"

#include <fmt/format.h>

#include "base/json.h"
#include "report/labels.h"
#include "report/pictures.h"

namespace kiln {

std::string levels_section(const std::vector<LevelComparison>& levels, const std::filesystem::path& scratch) {
  if (levels.empty()) return "";
  std::string html =
      "<section><h2>Levels of detail</h2>\n<p class=note>Coarser meshes that share the atlas and the planes. "
      "Differences "
      "are from the asset's own mesh, from the report's camera under its worst light; popping is the largest change of "
      "a pixel's radiance where a level takes the place of the one before, at its distance, before black: all pixels, "
      "and those inside both silhouettes.</p>\n<table><thead><tr><th>Level<th class=number>triangles<th "
      "class=number>error<th class=number>distance<th class=number>relative L²<th class=number>silhouette<th "
      "class=number>popping<th class=number>inside</thead><tbody>\n";
  for (const LevelComparison& level : levels)
    html += fmt::format(
        "<tr><td>{}<td class=number>{}<td class=number>{:.3g}<td class=number>{:.3g}<td class=number>{}<td "
        "class=number>{}<td class=number>{:.3f}<td class=number>{:.3f}\n",
        level.level, level.described.triangles, level.described.error, level.described.distance,
        metric_value("relative_l2", level.relative_l2),
        metric_value("silhouette_difference", level.silhouette_difference), level.popping, level.popping_inside);
  html += "</tbody></table>\n<div class=trio>\n";
  for (const LevelComparison& level : levels)
    html += fmt::format(
        "<figure><img alt='Level {}' src='{}'><figcaption><b>Level {}</b> · {} triangles</figcaption>"
        "</figure>\n",
        level.level, data_uri(shown_radiance(level.picture), scratch), level.level, level.described.triangles);
  return html + "</div></section>\n";
}

}  // namespace kiln
