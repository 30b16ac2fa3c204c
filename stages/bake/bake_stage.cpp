// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_stage.h"

#include "asset/format.h"
#include "bake/bake_settings.h"
#include "base/asset_layout.h"
#include "material/material_settings.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* metric_names =
    "software_renderer texels buried_texels moved_texels directions texel_directions_per_second coefficients channels "
    "occluder_triangles "
    "occluders_closed skipped.unoccluded_texels skipped.behind_tiles skipped.lit_tiles skipped.shadowed_tiles "
    "single_rays "
    "ambiguous refined quantisation_error bytes_out";

constexpr const char* names_of_texels =
    "width height seams.edges seams.seam_mismatch_mean_before seams.seam_mismatch_max_before "
    "seams.seam_mismatch_mean seams.seam_mismatch_max seams.change";

/// Metrics of --verify-directions; the last four are left out where the reference shares what it measures.
constexpr const char* names_of_verification =
    "verification.backend_texels verification.backend_difference verification.backend_difference_uncertainty "
    "verification.reference_directions verification.reference_texels verification.integration_error "
    "verification.integration_error_uncertainty verification.error verification.error_uncertainty "
    "verification.relighting_error verification.relighting_error_uncertainty";

constexpr const char* names_of_bounces =
    "bounces.count bounces.seconds bounces.cache_points bounces.cache_triangles bounces.cache_seconds "
    "bounces.kept_bytes";

constexpr const char* names_of_subsurface =
    "subsurface.hierarchy_error subsurface.error_points subsurface.largest_gain "
    "subsurface.capped_area subsurface.area_mm2 subsurface.area_correction subsurface.spacing_mm subsurface.seconds";

constexpr const char* names_of_adaptive =
    "adaptive.target adaptive.error adaptive.error_of_interpolated adaptive.held_out_texels adaptive.bound "
    "adaptive.rounds adaptive.baked_texels adaptive.interpolated_texels adaptive.texel_directions_saved "
    "adaptive.share_saved";

/// Tells whether a condition holds for the settings of the bake, defaults included.
template <class Is>
bool holds(const AssetSettings& settings, const Is& is) {
  const auto given = settings.find("bake");
  return is(settings_from(given == settings.end() ? StageSettings() : given->second, bake_options));
}

std::vector<MetricGroup> metric_groups() {
  using Settings = const AssetSettings&;
  using Bake = const BakeSettings&;
  return {{metric_names},
          {names_of_texels, "seams.", "per-vertex: false of bake", [](Settings all) { return !bakes_vertices(all); }},
          {"vertices vertices_facing_away receiver_distance_largest", "vertices", "per-vertex: true of bake",
           bakes_vertices},
          {names_of_verification, "verification.", "verify-directions of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.verify_directions != 0; }); }},
          {names_of_bounces, "bounces.", "bounces of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.bounces.any(); }); }},
          {"bounces.floor", "bounces.", "bounces of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.bounces.automatic; }); }},
          {names_of_subsurface, "subsurface.", "subsurface of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.subsurface.wanted(); }); }},
          {names_of_adaptive, "adaptive.", "adaptive of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.adaptive != 0; }); }},
          {"max_error.target max_error.estimated", "max_error.", "max-error of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.max_error.wanted; }); }},
          {"shadow_map.size shadow_map.error shadow_map.floor", "shadow_map.", "shadow-size: auto of bake",
           [](Settings all) { return holds(all, [](Bake bake) { return bake.shadow_size == 0; }); }}};
}

StageOptions options() { return StageOptions::of(bake_options); }

/// Adds what surrounds the asset, and the settings.
void add_scene_and_settings(StageRun& run, const AssetPlan& plan) {
  if (!plan.place.empty()) run.add({"--place", plan.place});
  for (const PlanNeighbour& neighbour : plan.neighbours) {
    run.add({"--neighbour", neighbour.text});
    run.inputs.push_back(neighbour.mesh);
  }
  run.add_settings(options(), plan.settings_of("bake"));
}

/// Returns the run that bakes the vertices of the low mesh.
StageRun vertex_run(const AssetPlan& plan, const BakeSettings& settings) {
  const fs::path prt = layout::stage_folder(plan.folder, "bake"), low = plan.folder / layout::low_mesh;
  StageRun run{"bake", {"kiln-bake", low.string()}};
  run.inputs = {plan.mesh, layout::record(plan.folder, "simplify"), low};
  run.outputs = {layout::record(plan.folder, "bake"), prt / vertex_mesh_name, prt / ranges_name};
  if (settings.receiver == BakeReceiver::high) run.add({"--occluder", command_word(plan.mesh)});
  run.checkpoint = layout::checkpoint_folder(prt);
  run.add({"-o", folder_word(prt)});
  return run;
}

StageRun run(const AssetPlan& plan) {
  const fs::path prt = layout::stage_folder(plan.folder, "bake"), atlas = plan.folder / layout::atlas_mesh;
  const fs::path normals = layout::stage_folder(plan.folder, "normals");
  const BakeSettings settings = settings_from(plan.settings_of("bake"), bake_options);
  if (settings.per_vertex) {
    StageRun run = vertex_run(plan, settings);
    add_scene_and_settings(run, plan);
    return run;
  }
  StageRun run{"bake", {"kiln-bake", atlas.string(), "--detail", folder_word(normals)}};
  run.inputs = {plan.mesh, layout::record(plan.folder, "atlas"), atlas, layout::record(plan.folder, "normals")};
  run.outputs = {layout::record(plan.folder, "bake")};
  // A low receiver lies beneath the high mesh here and above it there: it is in the shadow of its own mesh, which is
  // what kiln-bake takes where nothing is said.
  if (settings.receiver == BakeReceiver::high) run.add({"--occluder", command_word(plan.mesh)});
  if (plan.passes("lod")) {
    const fs::path levels = layout::stage_folder(plan.folder, "lod");
    run.add({"--levels", folder_word(levels)});
    run.inputs.push_back(layout::record(plan.folder, "lod"));
  }
  run.add({"-o", folder_word(prt)});
  add_scene_and_settings(run, plan);
  for (int i = 0; i < settings.bands * settings.bands; ++i) run.outputs.push_back(prt / plane_file(0, i));
  for (const char* name : {atlas_mesh_name, ranges_name}) run.outputs.push_back(prt / name);
  if (plan.passes("lod")) run.outputs.push_back(prt / level_file(1));
  if (settings.ship.normal_bits > 0) run.outputs.push_back(prt / normal_map_name);
  // Checkpoints are of blocks of directions, by which a bake that interpolates texels does not go.
  if (settings.adaptive == 0) run.checkpoint = layout::checkpoint_folder(prt);
  return run;
}

}  // namespace

const StageInfo& bake_stage() {
  static const StageInfo info = {
      .name = "bake", .options = options, .rivals = material_rivals(), .metrics = metric_groups(), .run = run};
  return info;
}

}  // namespace kiln
