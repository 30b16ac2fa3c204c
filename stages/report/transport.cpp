// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/transport.h"

#include <algorithm>
#include <fmt/format.h>

#include "base/html.h"
#include "base/json.h"
#include "report/labels.h"

namespace kiln {

namespace {

std::string percent(const Json& share) { return metric_value("relative_l2", share); }

/// Makes a row with a bar as long as the share; direct light is 100 %.
std::string light_row(const std::string& name, double share, const Json& seconds) {
  return fmt::format(
      "<tr><td>{}<td class=number>{}<td><div class='meter good'><i style='width:{:.1f}%'></i></div><td "
      "class=number>{}\n",
      name, percent(share), 100 * std::clamp(share, 0.0, 1.0), metric_value("seconds", seconds));
}

std::string bounces_table(const Json& bake) {
  const Json& bounces = bake.at("bounces");
  const Json energy = bounces.value("energy", Json::array()), seconds = bounces.value("seconds", Json::array());
  double of_others =
      bounces.value("cache_seconds", 0.0) + bake.value("subsurface", Json::object()).value("seconds", 0.0);
  for (const Json& each : seconds) of_others += each.get<double>();
  std::string html = fmt::format(
      "<p class=note>Length of the transfer vectors that a bounce adds, as a share of direct light's. Bounces before "
      "the last "
      "are gathered at {} points of the surface ({} triangles), the last at the texels, for all bounces at once; "
      "{}.</p>\n"
      "<table><thead><tr><th>Light<th class=number>Of direct<th><th class=number>Time</thead><tbody>\n",
      metric_value("cache_points", bounces.value("cache_points", Json(0))),
      metric_value("cache_triangles", bounces.value("cache_triangles", Json(0))),
      html_escaped(bounces.value("renderer", std::string())));
  html += light_row("direct", 1, bake.value("seconds", 0.0) - of_others);
  if (bounces.contains("cache_seconds"))
    html += fmt::format("<tr><td>direct, at the points<td><td><td class=number>{}\n",
                        metric_value("seconds", bounces["cache_seconds"]));
  for (std::size_t k = 0; k < energy.size(); ++k)
    html += light_row(fmt::format("bounce {}", k + 1), energy[k].get<double>(),
                      k < seconds.size() ? seconds[k] : Json(0.0));
  return html + "</tbody></table>\n";
}

std::string subsurface_table(const Json& subsurface) {
  const Json reflectance = subsurface.value("reflectance", Json::array()),
             energy = subsurface.value("energy", Json::array());
  std::string html = fmt::format(
      "<p class=note>Light that leaves the surface over light that arrives, from everywhere: of a half space of the "
      "material, "
      "and of this object. The octree's error is {} against every sample; {}.</p>\n<table><thead><tr><th>Channel<th "
      "class=number>Half space<th class=number>This object</thead><tbody>\n",
      metric_value("hierarchy_error", subsurface.value("hierarchy_error", Json(0.0))),
      metric_value("seconds", subsurface.value("seconds", Json(0.0))));
  for (std::size_t k = 0; k < std::min(reflectance.size(), energy.size()); ++k)
    html += fmt::format("<tr><td>{}<td class=number>{}<td class=number>{}\n",
                        energy.size() == 3 ? std::string(1, "RGB"[k]) : std::to_string(k), percent(reflectance[k]),
                        percent(energy[k]));
  return html + "</tbody></table>\n";
}

}  // namespace

bool scatters_light(const Json& bake) { return bake.contains("bounces") || bake.contains("subsurface"); }

std::size_t bounces_taken(const Json& bake) {
  return bake.value("bounces", Json::object()).value("energy", Json::array()).size();
}

std::string transport_section(const Json& bake) {
  std::string html;
  if (bake.contains("bounces")) html += "<section><h2>Light that bounces</h2>\n" + bounces_table(bake) + "</section>\n";
  if (bake.contains("subsurface"))
    html += "<section><h2>Light beneath the surface</h2>\n" + subsurface_table(bake.at("subsurface")) + "</section>\n";
  return html;
}

}  // namespace kiln
