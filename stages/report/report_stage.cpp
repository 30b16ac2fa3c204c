// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/report_stage.h"

#include "base/asset_layout.h"
#include "report/judging.h"
#include "report/report_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// What is known when budgets are judged: the report's memory is not.
constexpr const char* metric_names =
    "relative_l2 relative_l2_uncertainty root_mean_square silhouette_difference compared_pixels software_renderer "
    "render_seconds "
    "reference_seconds gpu_bytes seconds";

constexpr const char* error_names =
    "error.total error.uncertainty error.root_sum_of_causes error.samples error.reference_directions "
    "error.reference_bands "
    "error.causes.geometry error.causes.albedo error.causes.bands error.causes.bits "
    "error.causes.seams";

/// Tells whether a setting of a stage is left out, or has a value.
bool has(const AssetSettings& all, const char* stage, const char* name, const char* value) {
  const auto settings = all.find(stage);
  if (settings == all.end()) return true;
  const auto found = settings->second.find(name);
  return found == settings->second.end() || found->second == value;
}

bool bake_has(const AssetSettings& all, const char* name, const char* value) { return has(all, "bake", name, value); }

bool measures_others(const AssetSettings& all) {
  return !has(all, "report", "error-others", "false") && bake_has(all, "subsurface", "none");
}

StageOptions options() { return StageOptions::of(report_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path& folder = plan.folder;
  const fs::path page = folder / layout::report_page;
  StageRun run{"report", {"kiln-report", folder.string(), "-o", page.string(), "--high", command_word(plan.mesh)}};
  run.helpers = {"kiln-render"};
  run.inputs = {plan.mesh};
  const std::vector<const char*> of_texels = {"simplify", "atlas", "normals", "bake"},
                                 of_vertices = {"simplify", "bake"};
  for (const char* stage : bakes_vertices(plan.settings) ? of_vertices : of_texels)
    run.inputs.push_back(layout::record(folder, stage));
  run.outputs = {folder / report_record, page, folder / report_metrics, folder / report_cover};
  if (plan.passes("compress")) {
    run.add({"--compressed", folder_word(layout::stage_folder(folder, "compress"))});
    run.inputs.push_back(layout::record(folder, "compress"));
  }
  if (plan.passes("lod")) run.inputs.push_back(layout::record(folder, "lod"));
  if (plan.passes("probes")) {
    run.add({"--probes", folder_word(layout::stage_folder(folder, "probes"))});
    run.inputs.push_back(layout::record(folder, "probes"));
  }
  run.add_settings(options(), plan.settings_of("report"));
  for (const std::string& budget : plan.budgets) run.limits.insert(run.limits.end(), {"--budget", budget});
  return run;
}

}  // namespace

const StageInfo& report_stage() {
  static const StageInfo info = {
      .name = "report",
      .options = options,
      .metrics = {{metric_names},
                  {error_names},
                  {"error.causes.texels", "error.causes.texels", "per-vertex: false of bake",
                   [](const AssetSettings& all) { return !bakes_vertices(all); }},
                  {"error.causes.vertices", "error.causes.vertices", "per-vertex: true of bake", bakes_vertices},
                  {"error.at_vertices.error", "error.at_vertices.", "error-others of report, per-vertex: false of bake",
                   [](const AssetSettings& all) { return measures_others(all) && !bakes_vertices(all); }},
                  {"error.unshadowed.error", "error.unshadowed.", "error-others of report", measures_others},
                  {"error.causes.directions", "error.causes.directions", "subsurface of bake",
                   [](const AssetSettings& all) { return bake_has(all, "subsurface", "none"); }},
                  {"error.causes.visibility", "error.causes.visibility", "bounces or subsurface of bake",
                   [](const AssetSettings& all) {
                     return bake_has(all, "subsurface", "none") && bake_has(all, "bounces", "0");
                   }},
                  {"error.causes.shadows", "error.causes.shadows", "shadows: none of bake",
                   [](const AssetSettings& all) { return !bake_has(all, "shadows", "cast"); }},
                  {"error.causes.bounces", "error.causes.bounces", "bounces or subsurface of bake",
                   [](const AssetSettings& all) {
                     return bake_has(all, "subsurface", "none") && !bake_has(all, "bounces", "0");
                   }},
                  {"error.causes.subsurface", "error.causes.subsurface", "subsurface of bake",
                   [](const AssetSettings& all) { return !bake_has(all, "subsurface", "none"); }},
                  {"error.causes.receivers", "error.causes.receivers", "receiver: low of bake",
                   [](const AssetSettings& all) { return !bake_has(all, "receiver", "high"); }},
                  {"error.causes.compression", "error.causes.compression", "compress",
                   [](const AssetSettings& all) { return all.contains("compress"); }},
                  {"levels.relative_l2 levels.silhouette_difference levels.popping levels.popping_inside", "levels.",
                   "lod", [](const AssetSettings& all) { return all.contains("lod"); }},
                  {"compressed_relative_l2 compressed_gpu_bytes", "compressed_", "compress",
                   [](const AssetSettings& all) { return all.contains("compress"); }}},
      .run = run};
  return info;
}

}  // namespace kiln
