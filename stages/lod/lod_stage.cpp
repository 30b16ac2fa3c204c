// SPDX-License-Identifier: GPL-3.0-or-later
#include "lod/lod_stage.h"

#include "asset/format.h"
#include "base/asset_layout.h"
#include "lod/lod_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "level_count missed_goals triangles vertices error distance hausdorff_distance rms_distance "
    "high_hausdorff_distance high_rms_distance texel_displacement_mean texel_displacement_max "
    "overhanging_texels overlapping_texels deserted_texels overhang_limit radius atlas_triangles collapse_seconds";

StageOptions options() { return StageOptions::of(lod_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path folder = layout::stage_folder(plan.folder, "lod"), atlas = plan.folder / layout::atlas_mesh;
  StageRun run{"lod", {"kiln-lod", atlas.string(), "--high", command_word(plan.mesh), "-o", folder_word(folder)}};
  run.inputs = {plan.mesh, layout::record(plan.folder, "simplify"), layout::record(plan.folder, "atlas"), atlas};
  run.outputs = {layout::record(plan.folder, "lod")};
  // Levels that come out alike are one, so that only the first is certain.
  run.outputs.push_back(folder / level_file(1));
  run.add_settings(options(), plan.settings_of("lod"));
  return run;
}

}  // namespace

const StageInfo& lod_stage() {
  static const StageInfo info = {.name = "lod",
                                 .on_request = true,
                                 .list_setting = "levels",
                                 .options = options,
                                 .rivals = {{"levels", "pixels"}},
                                 .metrics = {{metric_names}},
                                 .run = run};
  return info;
}

}  // namespace kiln
