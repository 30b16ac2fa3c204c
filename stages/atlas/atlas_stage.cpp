// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/atlas_stage.h"

#include "atlas/atlas_settings.h"
#include "base/asset_layout.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "charts triangles vertices covered_texels utilisation stretch_l2 stretch_linf texels_per_unit density_min "
    "density_max seam_length seam_length_relative visible_seam_length_relative overlapping_texels flipped_triangles "
    "smallest_gap_texels uncovered_triangles uncovered_charts position_bits uv_bits width height gutter "
    "unfolded_charts lscm_charts arap_charts mean_value_charts split_charts degenerate_triangles kept uv_sets "
    "density_order "
    "chart_seconds density_seconds pack_seconds";

StageOptions options() { return StageOptions::of(atlas_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path low = plan.folder / layout::low_mesh, atlas = plan.folder / layout::atlas_mesh;
  const StageSettings& settings = plan.settings_of("atlas");
  StageRun run{"atlas", {"kiln-atlas", low.string(), "-o", atlas.string()}};
  run.inputs = {layout::record(plan.folder, "simplify"), low};
  run.outputs = {layout::record(plan.folder, "atlas"), atlas, plan.folder / layout::atlas_picture};
  if (settings_from(settings, atlas_options).density == AtlasDensity::transfer) {
    run.add({"--high", command_word(plan.mesh)});
    run.inputs.push_back(plan.mesh);
  }
  run.add_settings(options(), settings);
  return run;
}

}  // namespace

const StageInfo& atlas_stage() {
  static const StageInfo info = {.name = "atlas",
                                 .for_texels = true,
                                 .options = options,
                                 .rivals = {{"size", "texels-per-unit"}},
                                 .metrics = {{metric_names}},
                                 .run = run};
  return info;
}

}  // namespace kiln
