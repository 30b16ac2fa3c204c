// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/metrics.h"

#include <algorithm>
#include <string_view>

namespace kiln {

namespace {

/// Names between blanks.
constexpr const char* of_every_stage = "seconds peak_memory_bytes";

constexpr const char* of_simplify =
    "triangles vertices input_triangles dropped_components dropped_triangles dropped_area dropped_size hausdorff rms "
    "hausdorff_distance hausdorff_from_result manifold closed degenerate_triangles flipped_triangles collapse_seconds "
    "position_bits "
    "input_components input_border_loops hard_edges repairs.merged_vertices repairs.welded_vertices "
    "repairs.unused_vertices repairs.triangulated_polygons repairs.degenerate_triangles repairs.duplicate_triangles "
    "repairs.dropped_backs repairs.reversed_triangles repairs.nonmanifold_edges repairs.nonmanifold_vertices "
    "repairs.unorientable_edges repairs.inside_out_components repairs.clamped_colors repairs.filled_holes";

constexpr const char* of_atlas =
    "charts triangles vertices covered_texels utilisation stretch_l2 stretch_linf texels_per_unit density_min "
    "density_max seam_length seam_length_relative visible_seam_length_relative overlapping_texels flipped_triangles "
    "smallest_gap_texels uncovered_triangles uncovered_charts position_bits uv_bits width height gutter "
    "unfolded_charts lscm_charts arap_charts mean_value_charts split_charts degenerate_triangles kept density_order "
    "chart_seconds density_seconds pack_seconds";

/// The last six where the surface has an albedo that varies.
constexpr const char* of_normals =
    "width height covered_texels found_by_ray_outwards found_by_ray_inwards found_by_nearest_point disagreeing "
    "buried_texels cage_distance mean_distance largest_distance normal_deviation_degrees_mean "
    "normal_deviation_degrees_largest "
    "quantisation_degrees_largest map_error_degrees_mean map_error_degrees_p95 map_error_degrees_max seam_edges "
    "seam_mismatch_degrees_mean_before seam_mismatch_degrees_max_before seam_mismatch_degrees_mean "
    "seam_mismatch_degrees_max seam_change_degrees_rms measuring_seconds albedo.error_rms albedo.error_p95 "
    "albedo.seam_mismatch_mean_before albedo.seam_mismatch_max_before albedo.seam_mismatch_mean "
    "albedo.seam_mismatch_max";

constexpr const char* of_bake =
    "software_renderer texels buried_texels moved_texels directions texel_directions_per_second coefficients channels "
    "occluder_triangles "
    "occluders_closed skipped.unoccluded_texels skipped.behind_tiles skipped.lit_tiles skipped.shadowed_tiles "
    "ambiguous refined quantisation_error width height seams.edges seams.seam_mismatch_mean_before "
    "seams.seam_mismatch_max_before seams.seam_mismatch_mean seams.seam_mismatch_max seams.change";

/// The last four are left out where the reference shares what it measures.
constexpr const char* of_verification =
    "verification.backend_texels verification.backend_difference verification.backend_difference_uncertainty "
    "verification.reference_directions verification.reference_texels verification.integration_error "
    "verification.integration_error_uncertainty verification.error verification.error_uncertainty "
    "verification.relighting_error verification.relighting_error_uncertainty";

constexpr const char* of_bounces =
    "bounces.count bounces.seconds bounces.cache_points bounces.cache_triangles bounces.cache_seconds "
    "bounces.kept_bytes";

constexpr const char* of_subsurface =
    "subsurface.hierarchy_error subsurface.error_points subsurface.largest_gain "
    "subsurface.capped_area subsurface.area_mm2 subsurface.area_correction subsurface.spacing_mm subsurface.seconds";

constexpr const char* of_adaptive =
    "adaptive.target adaptive.error adaptive.error_of_interpolated adaptive.held_out_texels adaptive.bound "
    "adaptive.rounds adaptive.baked_texels adaptive.interpolated_texels adaptive.texel_directions_saved "
    "adaptive.share_saved";

constexpr const char* of_compress =
    "width height texels target_error error texel_error texel_error_bound border_jump border_jump_bound bytes_in "
    "bytes_out bytes_per_texel_in "
    "bytes_per_texel_out lookups_in lookups_out border_share plain.clusters plain.components plain.bits "
    "plain.step plain.error plain.texel_error plain.border_jump plain.bytes plain.lookups "
    "plain.lookups_at_borders plain.feasible chosen.clusters chosen.components chosen.bits chosen.step "
    "chosen.error chosen.texel_error chosen.border_jump chosen.bytes chosen.lookups chosen.lookups_at_borders "
    "chosen.feasible";

/// What is known when budgets are judged: the report's memory is not.
constexpr const char* of_report =
    "relative_l2 root_mean_square silhouette_difference compared_pixels software_renderer render_seconds "
    "reference_seconds seconds";

void add(std::vector<std::string>& metrics, Stage stage, std::string_view names) {
  while (!names.empty()) {
    const std::string_view name = names.substr(0, names.find(' '));
    metrics.push_back(stage_name(stage) + "." + std::string(name));
    names.remove_prefix(std::min(names.size(), name.size() + 1));
  }
}

void add_bake(std::vector<std::string>& metrics, const std::map<Stage, StageSettings>& settings) {
  const auto setting = [&](const char* name) { return effective_setting(settings, Stage::bake, name); };
  add(metrics, Stage::bake, of_bake);
  if (setting("verify-directions") != 0) add(metrics, Stage::bake, of_verification);
  if (setting("bounces") != "0") add(metrics, Stage::bake, of_bounces);
  if (setting("bounces") == "auto") add(metrics, Stage::bake, "bounces.floor");
  if (setting("subsurface") != "none") add(metrics, Stage::bake, of_subsurface);
  if (setting("adaptive") != 0) add(metrics, Stage::bake, of_adaptive);
  if (setting("max-error") != "none") add(metrics, Stage::bake, "max_error.target max_error.estimated");
  if (setting("shadow-size") == "auto") add(metrics, Stage::bake, "shadow_map.size shadow_map.error shadow_map.floor");
}

}  // namespace

std::vector<std::string> metrics_of(const std::map<Stage, StageSettings>& settings) {
  std::vector<std::string> metrics;
  for (const Stage stage : {Stage::simplify, Stage::atlas, Stage::normals, Stage::bake, Stage::compress})
    if (settings.contains(stage)) add(metrics, stage, of_every_stage);
  add(metrics, Stage::simplify, of_simplify);
  add(metrics, Stage::atlas, of_atlas);
  add(metrics, Stage::normals, of_normals);
  add_bake(metrics, settings);
  add(metrics, Stage::report, of_report);
  if (settings.contains(Stage::compress)) {
    add(metrics, Stage::compress, of_compress);
    add(metrics, Stage::report, "compressed_relative_l2");
  }
  return metrics;
}

std::string setting_of_metric(const std::string& metric) {
  constexpr std::pair<std::string_view, const char*> settings[] = {{"bake.verification.", "verify-directions of bake"},
                                                                   {"bake.bounces.", "bounces of bake"},
                                                                   {"bake.subsurface.", "subsurface of bake"},
                                                                   {"bake.adaptive.", "adaptive of bake"},
                                                                   {"bake.max_error.", "max-error of bake"},
                                                                   {"bake.shadow_map.", "shadow-size: auto of bake"},
                                                                   {"report.compressed_", "compress"}};
  for (const auto& [prefix, setting] : settings)
    if (metric.starts_with(prefix)) return setting;
  return "";
}

}  // namespace kiln
