// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page_tables.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include "base/html.h"
#include "base/json.h"
#include "report/labels.h"

namespace kiln {

namespace {

struct StageColor {
  const char* stage;
  const char* color;
};
constexpr std::array stage_colors = {StageColor{"simplify", "#7a5c3e"}, StageColor{"atlas", "#5f6b3a"},
                                     StageColor{"normals", "#3f6b6b"},  StageColor{"lod", "#4a5f86"},
                                     StageColor{"bake", "#8c4a2f"},     StageColor{"compress", "#7d4a66"},
                                     StageColor{"probes", "#8a6d2f"},   StageColor{"report", "#5a5568"}};

std::string row(const std::string& label, const std::string& value) {
  return fmt::format("<div><dt>{}</dt><dd>{}</dd></div>\n", html_escaped(label), value);
}

/// Makes the rows of a stage's metrics; those of an inner object as "outer: inner", unless zero.
std::string metric_rows(const std::string& stage, const Json& metrics) {
  std::string html;
  for (const auto& [key, value] : metrics.items()) {
    if (key == "stage" || key == "version" || key == "settings" || key == "inputs" || key == "outputs" ||
        key == "seconds" || key == "budgets_missed" || key == "verification" || key == "plain" || key == "chosen" ||
        (key == "bounces" && value.is_object()) || key == "subsurface" || value.is_array())
      continue;
    if (!value.is_object()) {
      html += row(metric_label(stage + "." + key), metric_value(key, value));
      continue;
    }
    for (const auto& [inner_key, inner] : value.items())
      if (!inner.is_structured() && (!inner.is_number() || inner.get<double>() != 0))
        html += row(metric_label(key) + ": " + metric_label(inner_key), metric_value(inner_key, inner));
  }
  return html;
}

std::string settings_rows(const Json& settings) {
  std::string html;
  for (const auto& [key, value] : settings.items())
    html += row(key, value.is_string()    ? html_escaped(value.get<std::string>())
                     : value.is_boolean() ? (value.get<bool>() ? "yes" : "no")
                                          : html_escaped(value.dump()));
  return html;
}

}  // namespace

std::string verification_section(const AssetFolder& asset) {
  const Json verification = asset.record("bake").value("verification", Json());
  std::string html = "<section><h2>Verification of the bake</h2>\n";
  if (!verification.is_object())
    return html +
           "<p class=note>The bake was not verified. <code>verify-directions</code> of kiln-bake has it compare itself "
           "with the other "
           "backend and with that many rays.</p></section>\n";
  html +=
      "<p class=note>The transfer vectors of covered texels against the other backend, and against a reference by rays "
      "over many more "
      "directions; as relative L² of the vectors, and as the error to expect of a picture under lighting as it is "
      "found in "
      "photographed environments.</p>\n<table><tbody>\n";
  for (const auto& [key, value] : verification.items())
    html += fmt::format("<tr><td>{}<td class=number>{}\n", html_escaped(metric_label(key)), metric_value(key, value));
  return html + "</tbody></table></section>\n";
}

std::string stages_section(const Json& metrics) {
  std::string bar, cards;
  double total = 0;
  for (const StageColor& stage : stage_colors)
    if (metrics.contains(stage.stage)) total += metrics.at(stage.stage).at("seconds").get<double>();
  for (const auto& [stage, color] : stage_colors) {
    if (!metrics.contains(stage)) continue;  // on request
    const Json& result = metrics.at(stage);
    const double seconds = result.at("seconds").get<double>();
    const std::string time = metric_value("seconds", result.at("seconds"));
    // A thin slice has no room for its name; the card names it.
    const std::string label = seconds > 0.08 * total ? stage + (" " + time) : std::string();
    bar += fmt::format("<span style='flex:{:.4f} 0 0;background:{}' title='{} {}'>{}</span>", std::max(seconds, 1e-4),
                       color, stage, time, label);
    cards += fmt::format(
        "<div class=card><h3><i style='background:{}'></i>{}<span>{}</span></h3>\n<dl "
        "class=rows>\n{}</dl>\n<details><summary>Settings</summary><dl "
        "class=rows>\n{}</dl></details></div>\n",
        color, stage, time, metric_rows(stage, result), settings_rows(result.value("settings", Json::object())));
  }
  return "<section><h2>Stages</h2>\n<p class=note>Each stage's own work, without reading and writing files, and what "
         "it measured on what it "
         "wrote.</p>\n<div class=times>" +
         bar + "</div>\n<div class=cards>\n" + cards + "</div></section>\n";
}

}  // namespace kiln
