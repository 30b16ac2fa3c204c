// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/simplify_stage.h"

#include "base/asset_layout.h"
#include "simplify/simplify_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "triangles vertices input_triangles dropped_components dropped_triangles dropped_area dropped_size hausdorff rms "
    "hausdorff_distance hausdorff_from_result manifold closed degenerate_triangles flipped_triangles collapse_seconds "
    "position_bits "
    "input_components input_border_loops hard_edges repairs.merged_vertices repairs.welded_vertices "
    "repairs.unused_vertices repairs.triangulated_polygons repairs.degenerate_triangles repairs.duplicate_triangles "
    "repairs.dropped_backs repairs.reversed_triangles repairs.nonmanifold_edges repairs.nonmanifold_vertices "
    "repairs.unorientable_edges repairs.inside_out_components repairs.clamped_colors repairs.filled_holes";

StageOptions options() { return StageOptions::of(simplify_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path low = plan.folder / layout::low_mesh;
  StageRun run{"simplify", {"kiln-simplify", command_word(plan.mesh), "-o", low.string()}};
  run.inputs = {plan.mesh};
  run.outputs = {layout::record(plan.folder, "simplify"), low};
  run.add_settings(options(), plan.settings_of("simplify"));
  return run;
}

}  // namespace

const StageInfo& simplify_stage() {
  static const StageInfo info = {.name = "simplify",
                                 .options = options,
                                 .rivals = {{"faces", "max-error"}},
                                 .metrics = {{metric_names}},
                                 .run = run};
  return info;
}

}  // namespace kiln
