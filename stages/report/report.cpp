// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report.h"

#include <algorithm>

#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"

namespace kiln {

namespace {

/// Returns the difference under the light where it is largest; not a number where one is not.
PictureDifference worst_difference(const std::vector<LightComparison>& lights) {
  PictureDifference worst;
  for (const LightComparison& light : lights)
    if (!(light.difference.relative_l2 <= worst.relative_l2)) worst = light.difference;
  return worst;
}

}  // namespace

Json Report::to_json() const {
  Json lights = Json::array();
  double root_mean_square = 0, compressed_relative_l2 = 0;
  bool is_compressed = false;
  for (const LightComparison& light : comparison.lights) {
    lights.push_back({{"light", light.light},
                      {"camera_azimuth", light.camera_azimuth_degrees},
                      {"relative_l2", light.difference.relative_l2},
                      {"relative_l2_uncertainty", light.difference.relative_l2_uncertainty},
                      {"root_mean_square", light.difference.root_mean_square},
                      {"largest", light.difference.largest},
                      {"reference_noise", light.difference.reference_noise},
                      {"relative_l2_in_full", light.difference_in_full.relative_l2}});
    if (light.compressed.width() > 0) {
      is_compressed = true;
      lights.back()["compressed_relative_l2"] = light.compressed_difference.relative_l2;
      compressed_relative_l2 = std::max(compressed_relative_l2, light.compressed_difference.relative_l2);
    }
    root_mean_square = std::max(root_mean_square, light.difference.root_mean_square);
  }
  const PictureDifference worst = worst_difference(comparison.lights);
  Json json = {{"relative_l2", worst.relative_l2},
               {"relative_l2_uncertainty", worst.relative_l2_uncertainty},
               {"root_mean_square", root_mean_square},
               {"silhouette_difference", comparison.silhouette_difference},
               {"compared_pixels", comparison.compared_pixels},
               {"renderer", comparison.renderer},
               {"software_renderer", comparison.software_renderer},
               {"render_seconds", comparison.render_seconds},
               {"reference_seconds", comparison.reference_seconds},
               {"gpu_bytes", comparison.gpu_bytes},
               {"lights", lights}};
  if (!comparison.lamp.empty()) json["lamp"] = comparison.lamp;
  put_verdicts(json, budgets);
  if (is_compressed) {
    json["compressed_relative_l2"] = compressed_relative_l2;
    json["compressed_gpu_bytes"] = comparison.compressed_gpu_bytes;
  }
  if (!comparison.levels.empty()) json["levels"] = kiln::to_json(comparison.levels);
  json["error"] = kiln::to_json(comparison.error);
  if (!comparison.predicted.empty()) json["error"]["predicted"] = comparison.predicted;
  return json;
}

Json all_metrics(const AssetFolder& asset, const Json& report_result) {
  Json metrics = {{"asset", asset.name}, {"version", KILN_VERSION}};
  for (const StageRecord& record : asset.records) metrics[record.stage] = record.json;
  metrics["report"] = report_result;
  if (report_result.contains("error")) metrics["error"] = report_result["error"];
  return metrics;
}

Report make_report(const AssetFolder& asset, const std::filesystem::path& high_file,
                   const std::vector<std::string>& budgets, const ReportSettings& settings, const ComparisonRun& run) {
  const Stopwatch watch;
  // Check budgets first: a mistyped metric should not cost the time of the comparison.
  std::vector<Budget> limits;
  const Json metrics_before = all_metrics(asset, Json::object());
  for (const std::string& text : budgets) {
    limits.push_back(parse_budget(text));
    if (!limits.back().metric.starts_with("report.")) judge_budget(limits.back(), metrics_before);
  }
  Report report;
  report.comparison = compare_with_reference(asset, high_file, settings, run);
  report.seconds = watch.seconds();
  Json own = report.to_json();
  own["seconds"] = report.seconds;
  const Json metrics = all_metrics(asset, own);
  for (const Budget& limit : limits) report.budgets.push_back(judge_budget(limit, metrics));
  return report;
}

}  // namespace kiln
