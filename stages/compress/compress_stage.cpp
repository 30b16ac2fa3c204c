// SPDX-License-Identifier: GPL-3.0-or-later
#include "compress/compress_stage.h"

#include "asset/format.h"
#include "asset/shipped.h"
#include "base/asset_layout.h"
#include "compress/compress_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "width height texels target_error error texel_error texel_error_bound border_jump border_jump_bound bytes_in "
    "bytes_out bytes_per_texel_in "
    "bytes_per_texel_out lookups_in lookups_out border_share plain.clusters plain.components plain.bits "
    "plain.step plain.error plain.texel_error plain.border_jump plain.bytes plain.lookups "
    "plain.lookups_at_borders plain.feasible chosen.clusters chosen.components chosen.bits chosen.step "
    "chosen.error chosen.texel_error chosen.border_jump chosen.bytes chosen.lookups chosen.lookups_at_borders "
    "chosen.feasible";

StageOptions options() { return StageOptions::of(compress_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path folder = layout::stage_folder(plan.folder, "compress");
  const std::string prt = folder_word(layout::stage_folder(plan.folder, "bake"));
  StageRun run{"compress", {"kiln-compress", prt, "-o", folder_word(folder)}};
  run.inputs = {layout::record(plan.folder, "bake")};
  // What else it writes is its own choice: planes, or weights with pca.json.
  run.outputs = {layout::record(plan.folder, "compress"), folder / atlas_mesh_name};
  const StageSettings& bake = plan.settings_of("bake");
  const auto ship = bake.find(ship_setting);
  if (ship == bake.end() || parse_shipped_parts(ship->second).normal_bits > 0)
    run.outputs.push_back(folder / normal_map_name);
  run.add_settings(options(), plan.settings_of("compress"));
  return run;
}

}  // namespace

const StageInfo& compress_stage() {
  static const StageInfo info = {
      .name = "compress", .on_request = true, .options = options, .metrics = {{metric_names}}, .run = run};
  return info;
}

}  // namespace kiln
