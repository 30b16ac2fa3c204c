// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_files.h"

#include <algorithm>

#include "asset/shipped.h"
#include "bake/levels.h"
#include "bake/planes/coefficient_planes.h"
#include "bake/planes/vertex_planes.h"
#include "bake/verify.h"
#include "base/asset_layout.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "maps/detail_maps.h"
#include "sh/directions.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

Json describe_adaptive(const AdaptiveReport& report, int directions) {
  const auto all = static_cast<double>(report.baked + report.interpolated);
  return {{"target", report.target},
          {"error", report.error},
          {"error_of_interpolated", report.error_of_interpolated},
          {"held_out_texels", report.held_out},
          {"bound", report.bound},
          {"rounds", report.rounds},
          {"baked_texels", report.baked},
          {"interpolated_texels", report.interpolated},
          {"texel_directions_saved", static_cast<double>(report.interpolated) * directions},
          {"share_saved", all > 0 ? static_cast<double>(report.interpolated) / all : 0}};
}

Json describe_subsurface(const SubsurfaceReport& report) {
  return {{"reflectance", report.reflectance},
          {"energy", report.energy},
          {"hierarchy_error", report.hierarchy_error},
          {"error_points", report.error_points},
          {"largest_gain", report.largest_gain},
          {"capped_area", report.capped_area},
          {"area_mm2", report.area_mm2},
          {"area_correction", report.area_correction},
          {"spacing_mm", report.spacing_mm},
          {"seconds", report.seconds}};
}

/// Copies a normal map of 16 bits, or writes it with 8.
void ship_normals(const fs::path& from, const fs::path& to, int bits) {
  if (bits == 16) {
    fs::copy_file(from, to, fs::copy_options::overwrite_existing);
    return;
  }
  const Image<std::uint16_t> wide = read_png16(from);
  Image<std::uint8_t> narrow(wide.width(), wide.height(), wide.channels());
  std::transform(wide.values().begin(), wide.values().end(), narrow.values().begin(),
                 [](std::uint16_t value) { return static_cast<std::uint8_t>((value + 128) / 257); });
  write_png(to, narrow);
}

/// Copies the further maps that ship. Throws BadInput for one that the folder of the normals stage has not.
std::vector<PrtMap> ship_maps(OutputSet& outputs, const fs::path& detail, const ShippedParts& ship) {
  std::vector<PrtMap> shipped;
  if (!ship.all_maps && ship.maps.empty()) return shipped;
  const fs::path record_file = layout::record_in(detail, "normals");
  const Json record = detail.empty() ? Json::object() : Json::parse(read_text(record_file), nullptr, false);
  const Json maps = record.is_object() ? record.value("map_files", Json::object()) : Json::object();
  std::vector<std::string> names = ship.maps;
  if (ship.all_maps)
    for (const auto& [name, entry] : maps.items()) names.push_back(name);
  for (const std::string& name : names) {
    if (!maps.contains(name))
      throw BadInput(record_file.string(), "has no map '" + name + "', which --ship names",
                     "it among the maps of the normals stage", "give kiln-normals --maps " + name);
    const Json& entry = maps[name];
    PrtMap map{name, entry.at("file").get<std::string>(), std::nullopt};
    if (entry.contains("min")) map.range = PlaneRange{entry["min"].get<double>(), entry["max"].get<double>()};
    fs::copy_file(detail / map.file, outputs.add(map.file), fs::copy_options::overwrite_existing);
    shipped.push_back(std::move(map));
  }
  return shipped;
}

/// Writes the planes of an atlas. Returns the metrics of storing and of the seams, for bake.json.
Json write_textured(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
                    const BakeSettings& settings) {
  PrtDescription asset;
  asset.mesh_file = atlas_mesh_name;
  asset.albedo = scene.albedo;
  asset.spectrum = scene.spectrum;
  asset.bits = settings.bits;
  fs::copy_file(paths.atlas, outputs.add(atlas_mesh_name), fs::copy_options::overwrite_existing);
  asset.levels = scene.levels;
  ship_levels(outputs, paths.levels, scene.levels);
  if (!paths.detail.empty() && settings.ship.normal_bits > 0) {
    asset.normals_file = normal_map_name;
    asset.normal_space = scene.normal_space;
    asset.normal_width = scene.own_normal_width;
    asset.normal_height = scene.own_normal_height;
    const char* file = scene.own_normal_width > 0 ? layout::own_normal_map : layout::normal_map;
    ship_normals(paths.detail / file, outputs.add(normal_map_name), settings.ship.normal_bits);
  } else {
    outputs.remove_stale(normal_map_name);
  }
  if (!asset.albedo.file.empty())
    fs::copy_file(paths.detail / albedo_map_name, outputs.add(albedo_map_name), fs::copy_options::overwrite_existing);
  else
    outputs.remove_stale(albedo_map_name);
  if (!asset.albedo.measured_file.empty())
    write_png(outputs.add(measured_map_name), asset.albedo.measured_at);
  else
    outputs.remove_stale(measured_map_name);
  if (scene.has_opacity_map) {
    asset.opacity_file = opacity_map_name;
    fs::copy_file(paths.detail / opacity_map_name, outputs.add(opacity_map_name), fs::copy_options::overwrite_existing);
  } else {
    outputs.remove_stale(opacity_map_name);
  }
  asset.maps = ship_maps(outputs, paths.detail, settings.ship);
  const Seams seams(scene.atlas, scene.receivers.width, scene.receivers.height);
  const WrittenPlanes done = write_planes(outputs, result.channels, scene.receivers, asset, seams, settings.seams);
  outputs.remove_stale(vertex_mesh_name);
  return {{"quantisation_error", done.quantisation_error},
          {"seams",
           {{"edges", seams.edges().size()},
            {"seam_mismatch_mean_before", done.before.mean},
            {"seam_mismatch_max_before", done.before.largest},
            {"seam_mismatch_mean", done.after.mean},
            {"seam_mismatch_max", done.after.largest},
            {"change", done.change}}}};
}

}  // namespace

std::vector<std::string> direction_warnings(const BakeSettings& settings) {
  if (!settings.casts_shadows) return {};
  const bool by_error = settings.max_error.wanted;  // then directions are progressive, as many as it takes
  const int most = by_error ? settings.max_directions : settings.directions;
  const std::int64_t needed =
      directions_for_bands(by_error ? Sampling::progressive : settings.sampling, settings.bands);
  if (most >= needed) return {};
  return {std::to_string(settings.bands) + " bands need " + std::to_string(needed) +
          " directions of this sampling or more, " + std::to_string(most) +
          " do not keep their functions apart, so that the upper bands hold light of others; allow more directions, or "
          "bake fewer bands"};
}

BakeJob make_job(const BakeScene& scene, const BakeSettings& settings, const CommandLine& command) {
  return {scene.receivers, scene.occluders, settings, command.seed(), command.threads()};
}

Json describe_bake(const BakeScene& scene, const BakeResult& result) {
  const double texel_directions = static_cast<double>(scene.receivers.slots.size()) * result.directions;
  const double integration_seconds = result.seconds - (result.subsurface ? result.subsurface->seconds : 0);
  Json metrics = {{"backend", backend_name(result.backend)},
                  {"renderer", result.renderer},
                  {"software_renderer", result.software_renderer},
                  {"texels", scene.receivers.slots.size() + scene.buried.buried},
                  {"buried_texels", scene.buried.buried},
                  {"moved_texels", scene.buried.moved},
                  {"directions", result.directions},
                  {"texel_directions_per_second", texel_directions / integration_seconds},
                  {"coefficients", result.channels.front().coefficients},
                  {"channels", result.channels.size()},
                  {"occluder_triangles", scene.occluders.mesh.triangles.size()},
                  {"occluders_closed", scene.occluders.closed},
                  {"neighbours", scene.neighbours}};
  if (result.choice)
    metrics["max_error"] = {{"target", result.choice->target_error}, {"estimated", result.choice->estimated_error}};
  if (result.shadow_choice)
    metrics["shadow_map"] = {{"size", result.shadow_choice->size_texels},
                             {"error", result.shadow_choice->error},
                             {"floor", result.shadow_choice->floor}};
  if (result.bounces) {
    const BounceReport& bounces = *result.bounces;
    metrics["bounces"] = {{"count", bounces.energy.size()},
                          {"renderer", bounces.renderer},
                          {"energy", bounces.energy},
                          {"seconds", bounces.seconds},
                          {"cache_points", bounces.cache_points},
                          {"cache_triangles", bounces.cache_triangles},
                          {"cache_seconds", bounces.cache_seconds},
                          {"kept_bytes", bounces.kept_bytes}};
    if (bounces.floor > 0) metrics["bounces"]["floor"] = bounces.floor;
  }
  // Count shares of all pairs of a texel and a direction.
  const auto all = static_cast<double>(result.work.pairs);
  const auto share = [&](std::uint64_t pairs) { return all > 0 ? static_cast<double>(pairs) / all : 0; };
  metrics["skipped"] = {
      {"unoccluded_texels", static_cast<double>(result.unoccluded) / static_cast<double>(scene.receivers.slots.size())},
      {"behind_tiles", share(result.work.behind_tiles)},
      {"lit_tiles", share(result.work.lit_tiles)},
      {"shadowed_tiles", share(result.work.shadowed_tiles)}};
  metrics["single_rays"] = share(result.work.single_rays);
  metrics["ambiguous"] = share(result.work.ambiguous);
  metrics["refined"] = share(result.work.refined);
  if (result.adaptive) metrics["adaptive"] = describe_adaptive(*result.adaptive, result.directions);
  if (result.subsurface) metrics["subsurface"] = describe_subsurface(*result.subsurface);
  return metrics;
}

namespace {

/// Returns each error, and beside it the bound that the error of all texels is within, with a confidence of 95 %.
Json describe_verification(const BakeVerification& verification) {
  Json json = {{"other_backend", verification.other_backend},
               {"backend_texels", verification.backend_texels},
               {"reference_directions", verification.reference_directions},
               {"reference_texels", verification.reference_texels}};
  const auto add = [&](const std::string& name, const SampledError& error) {
    json[name] = error.value;
    json[name + "_uncertainty"] = error.uncertainty;
  };
  add("backend_difference", verification.backend_difference);
  add("integration_error", verification.integration_error);
  if (verification.error) add("error", *verification.error);
  if (verification.relighting_error) add("relighting_error", *verification.relighting_error);
  return json;
}

}  // namespace

Json save_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
               const BakeSettings& settings, const CommandLine& command) {
  std::vector<TransferVectors> stored;
  Json places;  // metrics of the texels or vertices
  if (settings.per_vertex) {
    const std::vector<std::uint32_t> sources = write_vertex_planes(
        outputs, result.channels, scene.receivers, scene.vertex_mesh, settings.bits, scene.albedo, scene.spectrum);
    stored = read_transfer(outputs.staging(), stored_vertices(scene.receivers, sources));
    places = {{"vertices", sources.size()}, {"quantisation_error", relative_l2(stored, result.channels)}};
    places.update(scene.vertex_metrics);
  } else {
    places = write_textured(outputs, paths, scene, result, settings);
    stored = read_transfer(outputs.staging(), scene.receivers.slots);
    places.update({{"width", scene.receivers.width}, {"height", scene.receivers.height}});
  }

  Json metrics = describe_bake(scene, result);
  metrics.update(places);
  metrics["bytes_out"] = shipped_bytes(outputs.staging());
  if (settings.verify_directions > 0) {
    BakeJob job = make_job(scene, settings, command);
    job.progress = command.progress("verify");
    metrics["verification"] = describe_verification(verify(result, stored, job));
  }
  return metrics;
}

}  // namespace kiln
