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

constexpr const char* low_repair_names =
    "low_repairs.merged_vertices low_repairs.welded_vertices low_repairs.unused_vertices "
    "low_repairs.triangulated_polygons low_repairs.degenerate_triangles low_repairs.duplicate_triangles "
    "low_repairs.dropped_backs low_repairs.reversed_triangles low_repairs.nonmanifold_edges "
    "low_repairs.nonmanifold_vertices low_repairs.unorientable_edges low_repairs.inside_out_components "
    "low_repairs.clamped_colors low_repairs.filled_holes";

constexpr const char* kept_uv_names = "uv_deviation uv_deviation_rms";

bool keeps_uvs(const AssetSettings& settings) {
  const auto simplify = settings.find("simplify");
  if (simplify == settings.end()) return false;
  const auto keep = simplify->second.find("keep");
  return keep != simplify->second.end() && keep->second.find("uv") != std::string::npos;
}

bool has_own_low(const AssetSettings& settings) {
  const auto simplify = settings.find("simplify");
  return simplify != settings.end() && simplify->second.contains("low");
}

std::vector<std::pair<std::string, std::string>> rivals() {
  std::vector<std::pair<std::string, std::string>> rivals = {{"faces", "max-error"}};
  for (const char* option : steering_options()) rivals.emplace_back("low", option);
  return rivals;
}

StageOptions options() { return StageOptions::of(simplify_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path low = plan.folder / layout::low_mesh;
  StageRun run{"simplify", {"kiln-simplify", command_word(plan.mesh), "-o", low.string()}};
  run.inputs = {plan.mesh};
  StageSettings settings = plan.settings_of("simplify");
  if (const auto low_file = settings.find("low"); low_file != settings.end())
    run.inputs.emplace_back(low_file->second);
  else  // defaults may say how the low meshes of other assets are read
    for (const char* name : {"low-up", "low-unit", "low-scale"}) settings.erase(name);
  run.outputs = {layout::record(plan.folder, "simplify"), low};
  run.add_settings(options(), settings);
  return run;
}

}  // namespace

const StageInfo& simplify_stage() {
  static const StageInfo info = {.name = "simplify",
                                 .options = options,
                                 .rivals = rivals(),
                                 .metrics = {{metric_names},
                                             {low_repair_names, "low_repairs.", "low of simplify", has_own_low},
                                             {kept_uv_names, "uv_deviation", "uv for keep of simplify", keeps_uvs}},
                                 .run = run};
  return info;
}

}  // namespace kiln
