// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/page_summary.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <unistd.h>
#include <vector>

#include "base/html.h"
#include "base/json.h"
#include "report/cause_texts.h"
#include "report/labels.h"
#include "report/verdicts.h"

namespace kiln {

namespace {

constexpr std::size_t named_causes = 3;  // of the bar; the others are one part

std::string record_value(const Json& record, const char* key) {
  return record.contains(key) ? metric_value(key, record[key]) : std::string("–");
}

/// Returns the day of the report: of SOURCE_DATE_EPOCH where that is set, as reproducible builds do.
std::string today() {
  std::time_t now = std::time(nullptr);
  if (const char* epoch = std::getenv("SOURCE_DATE_EPOCH")) now = std::strtoll(epoch, nullptr, 10);
  return fmt::format("{:%Y-%m-%d}", fmt::gmtime(now));
}

std::string host() {
  std::array<char, 256> name{};
  return gethostname(name.data(), name.size() - 1) == 0 ? name.data() : "an unnamed host";
}

/// Causes, the largest first, those beyond the named ones as one.
std::vector<ErrorCause> parts_of(const ErrorSplit& split) {
  std::vector<ErrorCause> causes = split.causes;
  std::ranges::stable_sort(causes, std::greater<>(), &ErrorCause::error);
  ErrorCause others;
  while (causes.size() > named_causes) {
    others.error = std::hypot(others.error, causes.back().error);
    causes.pop_back();
  }
  if (others.error > 0) causes.push_back(others);
  return causes;
}

/// Says the error and where it comes from, and draws the causes' squares as one bar.
std::string error_part(const ErrorSplit& split) {
  const std::vector<ErrorCause> parts = parts_of(split);
  double sum = 0;
  for (const ErrorCause& part : parts) sum += part.error * part.error;
  std::string bar, legend;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const CauseText* text = find_cause_text(parts[k].name);
    const std::string name = text != nullptr ? text->phrase : parts[k].name.empty() ? "all else" : parts[k].name;
    if (sum > 0)
      bar += fmt::format("<i class=cause{} style='flex:{:.4f} 0 0'></i>", k, parts[k].error * parts[k].error / sum);
    legend += fmt::format("<li><i class=cause{}></i>{} {}</li>", k, metric_value("relighting_error", parts[k].error),
                          html_escaped(name));
  }
  return fmt::format(
      "<p class=found><b>{}</b> is what a viewer may expect to see it differ from the original by, relit by light as "
      "it "
      "is found in photographed surroundings.</p>\n<div class=causes role=img aria-label='Causes of the error by their "
      "squares'>{}</div>\n<ul class=causes-named>{}</ul>\n",
      metric_value("relighting_error", split.total), bar, legend);
}

/// Lists what the asset costs.
std::string facts(const AssetFolder& asset, const Report& report, const Json& metrics) {
  const Json &simplify = asset.record("simplify"), &bake = asset.record("bake");
  double seconds = 0, cpu = 0;
  const auto add = [&](const Json& record) {
    seconds += record.at("seconds").get<double>();
    cpu += record.value("cpu_seconds", 0.0);
  };
  for (const StageRecord& record : asset.records) add(record.json);
  add(metrics.at("report"));

  std::string html = "<dl class=figures>\n";
  const auto fact = [&](const std::string& name, const std::string& number, const std::string& more) {
    html += fmt::format("<div><dt>{}</dt><dd>{}<small>{}</small></dd></div>\n", name, number, more);
  };
  fact("Triangles", record_value(simplify, "triangles"), "of " + record_value(simplify, "input_triangles"));
  const bool compressed = !asset.compressed.empty();
  const auto compress_value = [&](const char* key) { return record_value(asset.record("compress"), key); };
  fact("On disk", record_value(bake, "bytes_out"),
       compressed ? compress_value("bytes_out") + " compressed" : "of prt/");
  fact("On the GPU", metric_value("gpu_bytes", report.comparison.gpu_bytes),
       compressed ? metric_value("gpu_bytes", report.comparison.compressed_gpu_bytes) + " compressed"
                  : "mesh, textures, light");
  // Wavelengths are read for a lamp as an asset is loaded, into three channels.
  const auto planes =
      asset.baked.spectrum ? 3 * asset.baked.bands * asset.baked.bands : static_cast<int>(asset.baked.planes.size());
  fact("Lookups", asset.is_per_vertex() ? "none" : grouped((planes + 3) / 4),
       asset.baked.spectrum    ? "of textures, a pixel, in one lamp's light"
       : compressed            ? compress_value("lookups_out") + " compressed"
       : asset.is_per_vertex() ? "transfer is at vertices"
                               : "of textures, a pixel");
  fact("Worst light", metric_value("relative_l2", metrics.at("report").at("relative_l2")), "off rays in its bands");
  fact("Made in", metric_value("seconds", seconds), metric_value("cpu_seconds", cpu) + " of CPU");
  return html + "</dl>\n";
}

/// Says which renderers were used, where that bears on the times.
std::string renderers(const AssetFolder& asset, const Report& report) {
  const Json& bake = asset.record("bake");
  std::string text;
  if (bake.contains("renderer")) text += "; baked by " + html_escaped(bake.at("renderer").get<std::string>());
  text += "; pictures by " + html_escaped(report.comparison.renderer);
  const bool baked_in_software = bake.value("software_renderer", Json(false)) == Json(true) &&
                                 bake.value("settings", Json::object()).value("backend", Json()) == Json("egl");
  if (report.comparison.software_renderer || baked_in_software)
    text += ", in software, so its times say nothing of a GPU";
  return text;
}

}  // namespace

std::string page_summary(const AssetFolder& asset, const Report& report, const Json& metrics,
                         const std::string& cover) {
  const Json& simplify = asset.record("simplify");
  std::string html = "<header>\n<div class=first>\n<div class=cover>" + cover + "</div>\n<div class=words>\n";
  html += fmt::format("<p class=overline>Kiln asset report</p>\n<h1>{}</h1>\n", html_escaped(asset.name));
  html += marked_verdict(report.budgets, metrics) + "\n" + error_part(report.comparison.error);
  html += fmt::format("<p class=note>{} triangles in place of {}, {} {} transfer {} of {} bits.</p>\n",
                      record_value(simplify, "triangles"), record_value(simplify, "input_triangles"),
                      asset.is_per_vertex() ? "each vertex with" : "a texture atlas, a normal map and",
                      asset.baked.planes.size(), asset.is_per_vertex() ? "values" : "planes", asset.baked.bits);
  html += "</div>\n</div>\n" + facts(asset, report, metrics);
  return html + fmt::format("<p class='note made'>Kiln {}, on {}, {}{}.</p>\n</header>\n",
                            html_escaped(metrics.at("version").get<std::string>()), html_escaped(host()), today(),
                            renderers(asset, report));
}

}  // namespace kiln
