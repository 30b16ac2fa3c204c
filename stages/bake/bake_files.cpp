// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_files.h"

#include <optional>
#include <utility>

#include "bake/backends.h"
#include "bake/planes/coefficient_planes.h"
#include "bake/planes/vertex_planes.h"
#include "bake/scene/vertex_receivers.h"
#include "bake/verify.h"
#include "base/command_line.h"
#include "base/errors.h"
#include "base/extent.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "maps/detail_maps.h"
#include "material/load_albedo.h"
#include "material/surroundings.h"
#include "mesh/draco_file.h"
#include "sh/directions.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr int default_size_texels = 512;

/// Returns the size that kiln-atlas packed for, from the record beside the atlas.
Extent packed_size(const fs::path& atlas) {
  const AssetHints hints = read_asset_hints(folder_of(atlas));
  return hints.width > 0 ? Extent(hints.width, hints.height) : Extent(default_size_texels);
}

/// Fills scene.occluders, with albedos where settings need them. Returns the meshes.
std::vector<TriangleMesh> load_occluders(const BakePaths& paths, const BakeSettings& settings, BakeScene& scene) {
  std::vector<TriangleMesh> meshes;
  std::vector<fs::path> files = paths.occluders;
  const AssetHints hints = read_asset_hints(folder_of(paths.atlas));
  ImportSettings how = inherit(settings.import, hints.import);
  if (files.empty()) {
    files.push_back(paths.atlas);
    if (is_draco_file(paths.atlas)) how = {};  // it is in our axes and units already
  }
  const MeshFrame& frame = settings.per_vertex ? scene.vertex_mesh.frame : scene.atlas.frame;
  if (settings.subsurface.wanted() && frame.exponent != 0)
    throw BadInput(paths.atlas.string(), "is a million times larger or smaller than one unit",
                   "a size that light scatters beneath, in millimetres", "make the asset anew with --scale or --unit");
  std::vector<ImportedMesh> imported;
  for (const fs::path& file : files) {
    imported.push_back(import_mesh(file, how, frame));
    scene.add_warnings(imported.back().warnings);
  }
  scene.said_warnings = hints.warnings;

  std::vector<SurfaceAlbedo> albedos;
  const bool bounces = settings.bounces.any(), with_albedo = bounces || settings.bake_albedo;
  const auto add_albedo = [&](const std::string& name, const LoadedAlbedo& loaded) {
    if (bounces && loaded.albedo.source() == SurfaceAlbedo::Source::none)
      throw WrongUsage("bounces: found no albedo in " + name +
                       "; expected materials, colours of vertices, --albedo or --albedo-texture");
    albedos.push_back(loaded.albedo);
    scene.further_files.insert(scene.further_files.end(), loaded.files.begin(), loaded.files.end());
    scene.add_warnings(loaded.warnings());
  };
  for (std::size_t k = 0; k < files.size() && with_albedo; ++k)
    add_albedo(files[k].string(), load_albedo(imported[k], settings.material));
  for (ImportedMesh& mesh : imported) meshes.push_back(std::move(mesh.mesh));

  // Add the surroundings.
  scene.neighbours = settings.surroundings.neighbours;
  BoundingBox own;
  for (const TriangleMesh& mesh : meshes) own.merge(bounding_box(mesh));
  for (PlacedMesh& placed : load_surroundings(settings.surroundings, own, settings.material, with_albedo, frame)) {
    scene.add_warnings(placed.warnings);
    meshes.push_back(std::move(placed.mesh));
    if (with_albedo) add_albedo(placed.name, placed.material);
    if (fs::is_regular_file(placed.name)) scene.further_files.emplace_back(placed.name);
  }
  scene.occluders = join_occluders(meshes, std::move(albedos));
  return meshes;
}

/// Sets aside receivers that are buried in the occluders, if they stand on them: points of the low mesh lie here and
/// there inside the high one, and are not buried.
void set_aside_buried(const BakePaths& paths, const BakeSettings& settings, BakeScene& scene) {
  const bool on_high = settings.receiver == BakeReceiver::high, high_shadows = !paths.occluders.empty();
  if (settings.buried == BuriedChoice::keep || settings.subsurface.wanted() || on_high != high_shadows) return;
  const float ray_offset = ray_offset_of(settings, scene.occluders.hull);
  scene.buried = settings.per_vertex
                     ? set_aside_buried_vertices(scene.receivers, scene.vertex_mesh, scene.occluders, ray_offset)
                     : set_aside_buried(scene.receivers, scene.atlas, scene.occluders, ray_offset);
  if (scene.buried.everything)
    scene.add_warnings(
        {"all of the surface stands inside another part of the occluders, where no light comes: it is baked "
         "as it is"});
}

/// Tells whether the transfer includes the albedo: then it must not be multiplied again, as if the surface were white.
bool has_albedo_within(const BakeSettings& settings) { return settings.bake_albedo || settings.subsurface.wanted(); }

BakeScene load_vertex_scene(const BakePaths& paths, const BakeSettings& settings) {
  if (!paths.detail.empty())
    throw WrongUsage(
        "per-vertex: found --detail; expected none, which is for texels; --receiver high takes the first "
        "--occluder as the high mesh");
  if (settings.adaptive > 0)
    throw WrongUsage("per-vertex: found --adaptive; expected none, it goes by squares of texels");
  if (settings.size.width != 0) throw WrongUsage("per-vertex: found --size; expected none, which is for texels");
  BakeScene scene;
  std::vector<std::string> warnings;
  scene.vertex_mesh = load_vertex_mesh(
      paths.atlas, inherit(settings.import, read_asset_hints(folder_of(paths.atlas)).import), &warnings);
  scene.add_warnings(warnings);
  const std::vector<TriangleMesh> occluders = load_occluders(paths, settings, scene);
  const bool on_high = settings.receiver == BakeReceiver::high && !paths.occluders.empty();
  VertexReceivers vertices = on_high ? receivers_on_high_of_vertices(scene.vertex_mesh, occluders.front())
                                     : receivers_on_vertices(scene.vertex_mesh);
  scene.receivers = std::move(vertices.receivers);
  if (on_high) scene.high_area = surface_area(occluders.front());
  for (std::size_t r = 0; r < scene.receivers.slots.size(); ++r)
    scene.vertex_mesh.normals[scene.receivers.slots[r]] = scene.receivers.normals[r];
  set_aside_buried(paths, settings, scene);
  if (settings.bake_albedo) take_albedos(scene.receivers, scene.occluders);
  scene.vertex_metrics = {{"receiver_distance_largest", vertices.largest_distance},
                          {"vertices_facing_away", vertices.facing_away}};
  if (has_albedo_within(settings))
    scene.albedo = PrtAlbedo::of_transfer();
  else if (const auto given = settings.material.albedo)
    scene.albedo = PrtAlbedo::of_constant({(*given)[0], (*given)[1], (*given)[2]});
  return scene;
}

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

/// Returns the albedo for ranges.json: that of the settings, else what the normals stage found.
PrtAlbedo shipped_albedo(const DetailMaps& detail, const MaterialSettings& material) {
  const auto given = material.albedo;
  if (given) return PrtAlbedo::of_constant({(*given)[0], (*given)[1], (*given)[2]});
  if (!detail.albedo.values().empty()) return PrtAlbedo::of_picture(albedo_map_name);
  return detail.albedo_known ? PrtAlbedo::of_constant(detail.constant_albedo) : PrtAlbedo();
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

/// Writes the planes of an atlas. Returns the metrics of storing and of the seams, for bake.json.
Json write_textured(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeResult& result,
                    const BakeSettings& settings) {
  PrtDescription asset;
  asset.mesh_file = atlas_mesh_name;
  asset.albedo = scene.albedo;
  asset.bits = settings.bits;
  fs::copy_file(paths.atlas, outputs.add(atlas_mesh_name), fs::copy_options::overwrite_existing);
  if (!paths.detail.empty()) {
    asset.normals_file = normal_map_name;
    asset.normal_space = scene.normal_space;
    fs::copy_file(paths.detail / normal_map_name, outputs.add(normal_map_name), fs::copy_options::overwrite_existing);
  } else {
    outputs.remove_stale(normal_map_name);
  }
  if (!asset.albedo.file.empty())
    fs::copy_file(paths.detail / albedo_map_name, outputs.add(albedo_map_name), fs::copy_options::overwrite_existing);
  else
    outputs.remove_stale(albedo_map_name);
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

void BakeScene::add_warnings(const std::vector<std::string>& further) {
  warnings.insert(warnings.end(), further.begin(), further.end());
}

std::vector<std::string> direction_warnings(const BakeSettings& settings) {
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

BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings) {
  subsurface_profiles(settings.subsurface);  // throws before anything is baked, if settings do not go together
  if (settings.subsurface.wanted() && settings.bake_albedo)
    throw WrongUsage("subsurface: found --bake-albedo; expected one of them, the material has its own albedo");
  if (settings.bits != 8 && settings.bits != 16)
    throw WrongUsage("bits: found '" + std::to_string(settings.bits) + "'; expected 8 or 16");
  if (settings.per_vertex) return load_vertex_scene(paths, settings);
  if (settings.receiver == BakeReceiver::high && paths.detail.empty())
    throw WrongUsage("receiver high: found no --detail FOLDER; expected the output of kiln-normals, or --receiver low");
  BakeScene scene;
  scene.atlas = load_atlas(paths.atlas);
  const TriangleMesh& atlas = scene.atlas;
  std::optional<DetailMaps> detail;
  if (!paths.detail.empty()) {
    detail = load_detail_maps(paths.detail, atlas);
    scene.albedo = has_albedo_within(settings) ? PrtAlbedo::of_transfer() : shipped_albedo(*detail, settings.material);
    scene.normal_space = detail->normal_space;
  }

  if (settings.receiver == BakeReceiver::high) {
    scene.receivers = receivers_on_high(*detail);
  } else {
    const Extent size = detail                    ? Extent(detail->width, detail->height)
                        : settings.size.width > 0 ? settings.size
                                                  : packed_size(paths.atlas);
    scene.receivers = receivers_on_low(atlas, size.width, size.height, detail ? &*detail : nullptr);
  }
  if (scene.receivers.slots.empty())
    throw BadInput(paths.atlas.string(), "covers no texel", "an atlas packed for this size", "bake at a larger size");

  const std::vector<TriangleMesh> occluders = load_occluders(paths, settings, scene);
  if (settings.receiver == BakeReceiver::high && !paths.occluders.empty())
    scene.high_area = surface_area(occluders.front());
  set_aside_buried(paths, settings, scene);
  if (settings.bake_albedo && detail && !settings.material.albedo)
    take_albedos(scene.receivers, *detail);
  else if (settings.bake_albedo)
    take_albedos(scene.receivers, scene.occluders);
  return scene;
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
    const std::vector<std::uint32_t> sources =
        write_vertex_planes(outputs, result.channels, scene.receivers, scene.vertex_mesh, settings.bits, scene.albedo);
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
  if (settings.verify_directions > 0) {
    BakeJob job = make_job(scene, settings, command);
    job.progress = command.progress("verify");
    metrics["verification"] = describe_verification(verify(result, stored, job));
  }
  return metrics;
}

}  // namespace kiln
