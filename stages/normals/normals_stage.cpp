// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/normals_stage.h"

#include "base/asset_layout.h"
#include "material/material_settings.h"
#include "normals/normals_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Names of the metrics: those of albedo where it varies, those of opacity where the surface is not opaque everywhere,
/// those of own_normal where the normal map that ships has a size of its own.
constexpr const char* metric_names =
    "width height covered_texels found_by_ray_outwards found_by_ray_inwards found_by_nearest_point disagreeing "
    "buried_texels cage_distance matched_parts mean_distance largest_distance normal_deviation_degrees_mean "
    "normal_deviation_degrees_largest "
    "quantisation_degrees_largest map_error_degrees_mean map_error_degrees_p95 map_error_degrees_max seam_edges "
    "seam_mismatch_degrees_mean_before seam_mismatch_degrees_max_before seam_mismatch_degrees_mean "
    "seam_mismatch_degrees_max seam_change_degrees_rms map_seconds measuring_seconds albedo.width albedo.height "
    "albedo.error_rms albedo.error_p95 "
    "albedo.seam_mismatch_mean_before albedo.seam_mismatch_max_before albedo.seam_mismatch_mean "
    "albedo.seam_mismatch_max opacity.width opacity.height opacity.share_there "
    "own_normal.width own_normal.height";

StageOptions options() { return StageOptions::of(normals_options); }

StageRun run(const AssetPlan& plan) {
  const fs::path folder = layout::stage_folder(plan.folder, "normals"), atlas = plan.folder / layout::atlas_mesh;
  StageRun run{"normals", {"kiln-normals", command_word(plan.mesh), atlas.string(), "-o", folder_word(folder)}};
  run.inputs = {plan.mesh, layout::record(plan.folder, "simplify"), layout::record(plan.folder, "atlas"), atlas};
  run.outputs = {layout::record(plan.folder, "normals")};
  for (const char* name : {layout::normal_map, layout::position_map, layout::coverage_map, layout::match_map})
    run.outputs.push_back(folder / name);
  const NormalsSettings settings = settings_from(plan.settings_of("normals"), normals_options);
  for (const MapKind kind : settings.maps.kinds)
    if (const fs::path file = folder / map_file(kind, settings.maps.format); file.filename() != layout::position_map)
      run.outputs.push_back(file);
  // What goes by the parts of the low mesh, or by its faces, reads the file that it came in.
  const StageSettings& simplify = plan.settings_of("simplify");
  const auto low = simplify.find("low");
  if (low != simplify.end() && settings.needs_low_file()) {
    run.add({"--low", command_word(low->second)});
    run.inputs.emplace_back(low->second);
  }
  if (!settings.cage_mesh.empty()) run.inputs.emplace_back(settings.cage_mesh);
  run.add_settings(options(), plan.settings_of("normals"));
  return run;
}

}  // namespace

const StageInfo& normals_stage() {
  static const StageInfo info = {.name = "normals",
                                 .for_texels = true,
                                 .options = options,
                                 .rivals = material_rivals({{"cage", "cage-mesh"}, {"part-cage", "cage-mesh"}}),
                                 .metrics = {{metric_names}},
                                 .run = run};
  return info;
}

}  // namespace kiln
