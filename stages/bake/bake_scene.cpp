// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_scene.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "bake/backends.h"
#include "bake/levels.h"
#include "bake/scene/measured_map.h"
#include "bake/scene/vertex_receivers.h"
#include "bake/spectral_channels.h"
#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/extent.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/json.h"
#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "maps/detail_maps.h"
#include "material/cut_out.h"
#include "material/load_albedo.h"
#include "material/measured_reflectance.h"
#include "material/surroundings.h"
#include "mesh/draco_file.h"

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
  const bool bounces = settings.bounces.any(), by_material = !settings.material.reflectance_of.empty();
  const bool with_albedo = bounces || settings.bake_albedo || by_material;
  const auto add_albedo = [&](const std::string& name, const LoadedAlbedo& loaded) {
    if (bounces && loaded.albedo.source() == SurfaceAlbedo::Source::none)
      throw WrongUsage("bounces: found no albedo in " + name +
                       "; expected materials, colours of vertices, --albedo, --albedo-texture or --reflectance");
    albedos.push_back(loaded.albedo);
    scene.further_files.insert(scene.further_files.end(), loaded.files.begin(), loaded.files.end());
    scene.add_warnings(loaded.warnings());
  };
  for (std::size_t k = 0; k < files.size() && with_albedo; ++k)
    add_albedo(files[k].string(), load_albedo(imported[k], settings.material));
  std::vector<std::uint8_t> all_sheets;
  const auto add_sheets = [&](const std::vector<std::uint8_t>& sheets, const TriangleMesh& mesh) {
    all_sheets.insert(all_sheets.end(), sheets.begin(), sheets.end());
    if (sheets.empty()) all_sheets.resize(all_sheets.size() + mesh.triangles.size(), 0);
  };
  for (std::size_t k = 0; k < files.size(); ++k) {
    const LoadedOpacity loaded = load_opacity(imported[k], settings.material);
    scene.add_warnings(loaded.warnings);
    scene.further_files.insert(scene.further_files.end(), loaded.files.begin(), loaded.files.end());
    meshes.push_back(std::move(imported[k].mesh));
    SurfaceAlbedo none;
    const std::vector<std::uint8_t> sheets =
        cut_occluder(meshes.back(), with_albedo ? albedos[k] : none, loaded.opacity, files[k].string());
    add_sheets(sheets, meshes.back());
    if (!sheets.empty() && settings.per_vertex)
      scene.add_warnings({"the surface is not opaque everywhere, which an asset baked per vertex does not show"});
  }

  // Add the surroundings.
  scene.neighbours = settings.surroundings.neighbours;
  BoundingBox own;
  for (const TriangleMesh& mesh : meshes) own.merge(bounding_box(mesh));
  for (PlacedMesh& placed : load_surroundings(settings.surroundings, own, settings.material, with_albedo, frame)) {
    scene.add_warnings(placed.warnings);
    meshes.push_back(std::move(placed.mesh));
    add_sheets(placed.sheets, meshes.back());
    if (with_albedo) add_albedo(placed.name, placed.material);
    scene.further_files.insert(scene.further_files.end(), placed.opacity_files.begin(), placed.opacity_files.end());
    if (fs::is_regular_file(placed.name)) scene.further_files.emplace_back(placed.name);
  }
  scene.occluders = join_occluders(meshes, std::move(albedos));
  if (!settings.spectrum.empty()) {
    scene.spectrum = read_spectral_channels(settings.spectrum);
    scene.further_files.emplace_back(settings.spectrum);
    scene.occluders.reflectance.emplace(scene.occluders, scene.spectrum->wavelengths_nm);
  }
  if (std::ranges::find(all_sheets, 1) != all_sheets.end()) scene.occluders.sheets = std::move(all_sheets);
  return meshes;
}

/// Sets aside receivers that are buried in the occluders, if they stand on them: points of the low mesh lie here and
/// there inside the high one, and are not buried.
void set_aside_buried(const BakePaths& paths, const BakeSettings& settings, BakeScene& scene) {
  const bool on_high = settings.receiver == BakeReceiver::high, high_shadows = !paths.occluders.empty();
  if (settings.buried == BuriedChoice::keep || settings.subsurface.wanted() || on_high != high_shadows ||
      !settings.casts_shadows)
    return;
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

/// Returns the albedo that the settings give for all of the surface; of a measured reflectance with its spectrum.
std::optional<PrtAlbedo> given_albedo(const BakeSettings& settings, BakeScene& scene) {
  const MaterialSettings& material = settings.material;
  if (material.albedo) return PrtAlbedo::of_constant(Eigen::Vector3f(material.albedo->data()));
  if (material.reflectance.empty()) return std::nullopt;
  const MeasuredReflectance measured = load_reflectance(material.reflectance);
  if (!settings.bounces.any()) scene.add_warnings(load_constant_albedo(material).warnings());
  scene.further_files.insert(scene.further_files.end(), measured.files.begin(), measured.files.end());
  PrtAlbedo albedo = PrtAlbedo::of_constant(measured.albedo);
  albedo.reflectance = shipped_reflectance(measured.spectrum.name, measured.spectrum.values);
  return albedo;
}

/// Throws where light is to bounce at wavelengths, beside what is computed as red, green and blue.
void require_bounces_of_spectrum(const BakeSettings& settings) {
  if (settings.spectrum.empty()) return;
  const auto refuse = [](bool is_so, const std::string& found, const std::string& expected) {
    if (is_so) throw WrongUsage("spectrum: found " + found + "; expected " + expected);
  };
  refuse(!settings.bounces.any(), "no bounces", "--bounces, since direct transfer is the same at all wavelengths");
  refuse(settings.bake_albedo, "bake-albedo", "the albedo outside of the transfer, where lamps decide its colour");
  refuse(settings.subsurface.wanted(), "subsurface", "none, whose materials are measured as red, green and blue");
}

/// Throws where the maps of the normals stage have the colours of other measured materials.
void require_same_materials(const fs::path& detail, const std::string& reflectance_of) {
  const fs::path file = layout::record_in(detail, "normals");
  std::error_code error;
  const Json record = fs::is_regular_file(file, error) ? Json::parse(read_text(file), nullptr, false) : Json::object();
  const Json settings = record.is_object() ? record.value("settings", Json::object()) : Json::object();
  const std::string of_maps = settings.is_object() ? settings.value("reflectance-of", std::string()) : std::string();
  if (reflectances_of_materials(of_maps) != reflectances_of_materials(reflectance_of))
    throw BadInput(file.string(), "has an albedo made with --reflectance-of '" + of_maps + "'",
                   "the bake's, '" + reflectance_of + "'", "run kiln-normals again with the same option");
}

BakeScene load_vertex_scene(const BakePaths& paths, const BakeSettings& settings) {
  if (!paths.detail.empty())
    throw WrongUsage(
        "per-vertex: found --detail; expected none, which is for texels; --receiver high takes the first "
        "--occluder as the high mesh");
  if (!paths.levels.empty())
    throw WrongUsage("per-vertex: found --levels; expected none, which share the texels of an atlas");
  if (settings.adaptive > 0)
    throw WrongUsage("per-vertex: found --adaptive; expected none, it goes by squares of texels");
  if (settings.ship.all_maps || !settings.ship.maps.empty())
    throw WrongUsage("per-vertex: found maps in --ship; expected none, they are looked up with the uvs of an atlas");
  if (!settings.material.reflectance_of.empty())
    throw WrongUsage("per-vertex: found --reflectance-of; expected none, whose map is of texels, or --reflectance");
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
  else if (auto given = given_albedo(settings, scene))
    scene.albedo = std::move(*given);
  return scene;
}

/// Returns the albedo for ranges.json: that of the settings, else what the normals stage found.
PrtAlbedo shipped_albedo(const DetailMaps& detail, const BakeSettings& settings, BakeScene& scene) {
  if (auto given = given_albedo(settings, scene)) return *given;
  if (!detail.albedo.values().empty()) {
    PrtAlbedo albedo = PrtAlbedo::of_picture(albedo_map_name);
    if (detail.albedo_width != detail.width || detail.albedo_height != detail.height) {
      albedo.width = detail.albedo_width;
      albedo.height = detail.albedo_height;
    }
    return albedo;
  }
  return detail.albedo_known ? PrtAlbedo::of_constant(detail.constant_albedo) : PrtAlbedo();
}

}  // namespace

void BakeScene::add_warnings(const std::vector<std::string>& further) {
  warnings.insert(warnings.end(), further.begin(), further.end());
}

BakeScene load_bake_scene(const BakePaths& paths, const BakeSettings& settings) {
  check_shadows(settings);
  subsurface_profiles(settings.subsurface);  // throws before anything is baked, if settings do not go together
  if (settings.subsurface.wanted() && settings.bake_albedo)
    throw WrongUsage("subsurface: found --bake-albedo; expected one of them, the material has its own albedo");
  if (settings.bits != 8 && settings.bits != 16)
    throw WrongUsage("bits: found '" + std::to_string(settings.bits) + "'; expected 8 or 16");
  require_bounces_of_spectrum(settings);
  require_one_albedo(settings.material);
  if (settings.per_vertex) return load_vertex_scene(paths, settings);
  if (settings.receiver == BakeReceiver::high && paths.detail.empty())
    throw WrongUsage("receiver high: found no --detail FOLDER; expected the output of kiln-normals, or --receiver low");
  BakeScene scene;
  scene.atlas = load_atlas(paths.atlas);
  const TriangleMesh& atlas = scene.atlas;
  if (!paths.levels.empty()) {
    scene.levels = load_levels(paths.levels, paths.atlas);
    for (const PrtLevel& level : scene.levels) scene.further_files.push_back(paths.levels / level.mesh_file);
  }
  std::optional<DetailMaps> detail;
  if (!paths.detail.empty()) {
    detail = load_detail_maps(paths.detail, atlas);
    scene.albedo = has_albedo_within(settings) ? PrtAlbedo::of_transfer() : shipped_albedo(*detail, settings, scene);
    scene.normal_space = detail->normal_space;
    scene.own_normal_width = detail->own_normal_width;
    scene.own_normal_height = detail->own_normal_height;
    scene.has_opacity_map = detail->has_opacity;
    if (detail->has_opacity && paths.occluders.empty())
      scene.add_warnings(
          {"the low mesh casts shadows as if it were opaque, although its maps have opacity; give "
           "--occluder the high mesh"});
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
  if (!settings.material.reflectance_of.empty() && !has_albedo_within(settings)) {
    if (scene.albedo.file.empty())
      throw WrongUsage(
          "reflectance-of: found no map of the albedo in --detail; expected the output of kiln-normals, "
          "which was given the same --reflectance-of");
    require_same_materials(paths.detail, settings.material.reflectance_of);
    add_measured_materials(scene.albedo, scene.receivers, scene.occluders);
  }
  set_aside_buried(paths, settings, scene);
  if (settings.bake_albedo && detail && !settings.material.albedo && settings.material.reflectance.empty())
    take_albedos(scene.receivers, *detail);
  else if (settings.bake_albedo)
    take_albedos(scene.receivers, scene.occluders);
  return scene;
}

}  // namespace kiln
