// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/comparison.h"

#include <cmath>
#include <numbers>
#include <optional>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "import/import_mesh.h"
#include "material/cut_out.h"
#include "material/load_albedo.h"
#include "mesh/camera_record.h"
#include "mesh/draco_file.h"
#include "report/picture_lamp.h"
#include "report/pictures.h"
#include "report/recorded_scene.h"
#include "report/reference.h"
#include "report/render_asset.h"
#include "report/split_asset.h"
#include "report/transport.h"
#include "scatter/subsurface_settings.h"
#include "sh/light_spec.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr double split_share = 0.3;  // share of the progress

/// A camera, and the lights under which it shows the asset.
struct CameraView {
  double azimuth_degrees = 0;
  std::vector<std::string> lights;
};

/// Returns a light turned about the vertical.
std::string turned(const std::string& text, double degrees) {
  LightSpec light = parse_light_spec(text);
  const double azimuth = light.azimuth_degrees + degrees, turn = degrees * std::numbers::pi / 180;
  light.azimuth_degrees = azimuth > 360 ? azimuth - 360 : azimuth;
  const auto [x, y, z] = light.position;
  light.position = {x * std::cos(turn) + z * std::sin(turn), y, z * std::cos(turn) - x * std::sin(turn)};
  return to_text(light);
}

/// Returns the cameras around the asset: the one of the settings, with all lights, then others evenly about the
/// vertical, each with the first light, which turns with the camera so that it sees as much of it.
std::vector<CameraView> camera_views(const ReportSettings& settings) {
  const std::vector<std::string> lights = list_of(settings.lights);
  parse_lights("lights", lights);  // refuses what is none
  std::vector<CameraView> views = {{settings.camera_azimuth_degrees, lights}};
  for (int k = 1; k < settings.cameras; ++k) {
    const double turn = 360.0 * k / settings.cameras, azimuth = settings.camera_azimuth_degrees + turn;
    views.push_back({azimuth > 360 ? azimuth - 360 : azimuth, {turned(lights.front(), turn)}});
  }
  return views;
}

/// Returns the memory of one asset that kiln-render drew.
std::uint64_t gpu_bytes_of(const Json& drawn) {
  const auto bytes = [&](const char* name) { return drawn.at(name).get<std::uint64_t>(); };
  return bytes("gpu_bytes_per_mesh") + bytes("gpu_bytes_per_vertex") * bytes("vertices") + bytes("gpu_bytes_indices");
}

}  // namespace

Comparison compare_with_reference(const AssetFolder& asset, const fs::path& high_file, const ReportSettings& settings,
                                  const ComparisonRun& run) {
  Comparison comparison;
  std::optional<PictureLamp> lamp;
  if (asset.baked.spectrum) {
    lamp = picture_lamp(asset.baked);
    require_no_color("lights", parse_lights("lights", list_of(settings.lights)));
    comparison.lamp = lamp->name;
  }
  const double albedo = settings.albedo_factor(asset.baked.albedo.known);
  const std::vector<CameraView> views = camera_views(settings);

  // Draw the asset by the program that reads only its files.
  const Stopwatch render_watch;
  std::vector<Camera> cameras;
  for (const CameraView& view : views) {
    const RenderedView drawn = {.azimuth_degrees = view.azimuth_degrees,
                                .elevation_degrees = settings.camera_elevation_degrees,
                                .framing = settings.framing,
                                .size = settings.picture_size,
                                .albedo = albedo,
                                .gl_device = settings.gl_device,
                                .compressed = !asset.compressed.empty()};
    Rendered rendered = render_asset(asset, drawn, view.lights, run);
    comparison.renderer = rendered.said.at("renderer").get<std::string>();
    comparison.software_renderer = rendered.said.at("software_renderer").get<bool>();
    const Json& drawn_assets = rendered.said.at("assets");
    comparison.gpu_bytes = gpu_bytes_of(drawn_assets.at(0));
    if (drawn_assets.size() > 1) comparison.compressed_gpu_bytes = gpu_bytes_of(drawn_assets.at(1));
    cameras.push_back(camera_of_json(rendered.said.at("camera")));
    for (std::size_t k = 0; k < view.lights.size(); ++k) {
      LightComparison& light = comparison.lights.emplace_back();
      light.light = view.lights[k];
      light.camera_azimuth_degrees = view.azimuth_degrees;
      light.asset = std::move(rendered.pictures[k]);
      if (asset.compressed.empty()) continue;
      light.compressed = std::move(rendered.pictures[view.lights.size() + k]);
      light.compressed_difference = compare_pictures(light.compressed, light.asset);
    }
  }
  if (!asset.baked.levels.empty()) comparison.levels = compare_levels(asset, albedo, settings, run);
  comparison.render_seconds = render_watch.seconds();

  // Draw the high mesh by rays, from the very cameras that kiln-render used.
  const Stopwatch reference_watch;
  const TriangleMesh atlas =
      asset.is_per_vertex() ? load_prt_asset(asset.prt()).mesh : load_atlas(asset.prt() / layout::atlas_mesh);
  const ImportSettings how = import_settings_of(asset.record("simplify").value("settings", Json::object()));
  const ImportedMesh imported = import_mesh(high_file, how, atlas.frame);  // as in the stages before
  TriangleMesh high = imported.mesh;
  ReferenceView view;
  view.width = view.height = settings.picture_size;
  view.supersample = drawn_supersample;
  view.albedo = static_cast<float>(albedo);
  const SubsurfaceSettings subsurface = settings_of(asset.record("bake"), add_subsurface_options);
  if (subsurface.wanted()) {
    view.scattering = subsurface_profiles(subsurface);  // has the albedo within
    view.mm_per_unit = subsurface.mm_per_unit;
  } else if (asset.baked.albedo.known) {
    view.surface_albedo = load_albedo(imported, surface_material(asset)).albedo;
  }
  cut_occluder(high, view.surface_albedo, load_opacity(imported, map_material(asset)).opacity, high_file.string());
  view.bounces = static_cast<int>(bounces_taken(asset.record("bake")));
  view.scene = scene_of(asset, imported, view.bounces > 0 || error_bounces(asset, settings) > 0);
  view.bands = asset.baked.bands;
  if (lamp) view.spectral = lamp->view;
  // Take other directions than the bake, so that an error of the bake's does not cancel.
  const ReferenceRays rays{settings.directions, static_cast<std::uint64_t>(run.seed) + 1};
  auto light = comparison.lights.begin();
  for (std::size_t v = 0; v < views.size(); ++v) {
    view.camera = cameras[v];
    const double begin = static_cast<double>(v) / static_cast<double>(views.size()),
                 end = static_cast<double>(v + 1) / static_cast<double>(views.size());
    for (const ReferencePicture& reference :
         reference_pictures(high, view, parse_lights("lights", views[v].lights), rays,
                            part_of(run.progress, (1 - split_share) * begin, (1 - split_share) * end))) {
      light->difference = compare_pictures(light->asset, reference.in_bands);
      light->difference_in_full = compare_pictures(light->asset, reference.in_full);
      light->reference = mean_of(reference.in_bands);
      light->reference_in_full = mean_of(reference.in_full);
      ++light;
    }
  }
  comparison.compared_pixels = comparison.lights.front().difference.pixels;
  comparison.error = split_error(asset, atlas, {high, view.surface_albedo, view.scene}, settings, run,
                                 part_of(run.progress, 1 - split_share, 1));
  comparison.predicted = settings.predictions();
  comparison.reference_seconds = reference_watch.seconds();
  comparison.silhouette_difference =
      silhouette_difference(comparison.lights.front().asset, comparison.lights.front().reference);
  return comparison;
}

}  // namespace kiln
