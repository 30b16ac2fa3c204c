// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/comparison.h"

#include <cmath>
#include <numbers>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "import/import_mesh.h"
#include "material/cut_out.h"
#include "material/load_albedo.h"
#include "material/surroundings.h"
#include "mesh/camera_record.h"
#include "mesh/draco_file.h"
#include "report/pictures.h"
#include "report/reference.h"
#include "report/render_asset.h"
#include "report/transport.h"
#include "scatter/subsurface_settings.h"
#include "sh/directions.h"
#include "sh/light_prior.h"
#include "sh/light_spec.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr double split_share = 0.3;  // share of the progress

std::vector<LightSpec> parse_lights(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<LightSpec> specs;
  specs.reserve(texts.size());
  for (const std::string& text : texts) specs.push_back(parse_light_spec(text));
  if (specs.empty()) throw WrongUsage(option + ": found none; expected at least one, as in '45,30; ambient:1'");
  return specs;
}

/// Tells whether the normals stage found or was given an albedo, or the bake has a material's.
bool has_albedo(const AssetFolder& asset) {
  return asset.record("bake").contains("subsurface") ||
         asset.record("normals").value("albedo", Json::object()).value("source", "none") != "none";
}

/// Returns settings as the record of a stage has them; an empty text there is the default. `add_options` makes the
/// options that hold them.
template <class Settings>
Settings settings_of(const Json& record, void (*add_options)(OptionSet&, Settings&)) {
  Settings settings;
  OptionSet options;
  add_options(options, settings);
  const Json recorded = record.value("settings", Json::object());
  for (const Option& option : options.options()) {
    const auto value = recorded.find(option.name);
    if (value == recorded.end()) continue;
    const std::string text = value->is_string() ? value->get<std::string>() : value->dump();
    if (!text.empty()) option.set(text);
  }
  return settings;
}

MaterialSettings material_of(const Json& record) { return settings_of(record, add_material_options); }

/// Returns the high mesh and the bake's surroundings, with the albedos of the bake's settings where light bounces.
SceneMesh scene_of(const AssetFolder& asset, const ImportedMesh& high, bool bounces) {
  const Json& bake = asset.record("bake");
  Surroundings surroundings = settings_of(bake, add_surroundings_options);
  surroundings.neighbours = bake.value("neighbours", surroundings.neighbours);
  const MaterialSettings material = material_of(bake);
  SceneMesh scene;
  const auto add = [&](const TriangleMesh& mesh, const SurfaceAlbedo& albedo) {
    if (bounces)
      scene.add(mesh, albedo);
    else
      scene.add(mesh);
  };
  TriangleMesh own = high.mesh;
  SurfaceAlbedo albedo = bounces ? load_albedo(high, material).albedo : SurfaceAlbedo();
  cut_occluder(own, albedo, load_opacity(high, material).opacity, high.file.string());
  add(own, albedo);
  for (const PlacedMesh& placed :
       load_surroundings(surroundings, bounding_box(high.mesh), material, bounces, high.mesh.frame))
    add(placed.mesh, placed.material.albedo);
  return scene;
}

/// Returns how often light bounces in what the error is measured against.
int error_bounces(const AssetFolder& asset, const ReportSettings& settings) {
  return settings.error_bounces.value_or(static_cast<int>(bounces_taken(asset.record("bake"))));
}

/// Returns why the causes of the error are not measured; empty if they are.
std::string left_out(const AssetFolder& asset) {
  const Json& bake = asset.record("bake");
  const Json settings = bake.value("settings", Json::object());
  if (bake.contains("subsurface")) return "light scatters beneath the surface, which the split does not follow";
  if (asset.baked.vertices > 0) return "the asset is baked per vertex";
  if (settings.value("bake-albedo", false)) return "the transfer has the albedo within";
  if (settings.value("receiver", std::string("high")) != "high") return "the bake's receivers are on the low mesh";
  return {};
}

/// Returns the directions of the bake.
std::vector<Eigen::Vector3f> directions_of(const Json& bake) {
  const Json& settings = bake.at("settings");
  const std::string sampling = settings.value("sampling", std::string("fibonacci"));
  const bool by_error = settings.value("max-error", std::string("none")) != "none";
  return sample_directions(by_error                    ? Sampling::progressive
                           : sampling == "stratified"  ? Sampling::stratified
                           : sampling == "progressive" ? Sampling::progressive
                                                       : Sampling::fibonacci,
                           bake.at("directions").get<int>(), settings.value("seed", std::uint64_t{1}));
}

/// Returns the moments by band of the light that the error is expected under: of several lights the mean, each scaled
/// to the same mean square of an unshadowed surface's exit radiance, as lighting_prior's.
std::vector<double> prior_of(const ReportSettings& settings, int bands) {
  if (settings.error_lights == "measured") return lighting_prior(bands);
  std::vector<double> mean(static_cast<std::size_t>(bands));
  for (const LightSpec& light : parse_lights("error-lights", list_of(settings.error_lights))) {
    const std::vector<double> moments = band_moments(light_coefficients(light, bands));
    const double square = unshadowed_exit_square(moments);
    if (square > 0)
      for (std::size_t l = 0; l < mean.size(); ++l) mean[l] += moments[l] / square;
  }
  if (mean[0] <= 0)
    throw WrongUsage("error-lights: found '" + settings.error_lights + "', which are dark; expected light");
  return mean;
}

/// Cuts away what the map of opacity of an asset does not show of its mesh.
TriangleMesh cut_by_map(const TriangleMesh& low, const fs::path& opacity_map) {
  constexpr auto edge = ChannelTexture::Wrap::clamp;
  const auto texture = std::make_shared<const ChannelTexture>(SourcePicture{opacity_map, nullptr, opacity_map.string()},
                                                              SourceShare::Channel::grey);
  SurfaceShare::Materials materials;
  materials.all.push_back({.texture = texture, .wrap_u = edge, .wrap_v = edge});
  materials.of_triangle.assign(low.triangles.size(), 0);
  for (const Triangle& t : low.triangles) materials.uvs.push_back({low.uvs[t[0]], low.uvs[t[1]], low.uvs[t[2]]});
  return cut_out(low, {SurfaceShare(std::move(materials)), {0.5f}}, opacity_map.string()).mesh;
}

ErrorSplit split_error(const AssetFolder& asset, const TriangleMesh& low, const TriangleMesh& high,
                       const SceneMesh& scene, const ReportSettings& settings, const ComparisonRun& run) {
  const PrtAsset plain = load_prt_asset(asset.prt());
  std::optional<PrtAsset> compressed;
  if (!asset.compressed.empty()) compressed = load_prt_asset(asset.compressed);
  const DetailMaps detail = load_detail_maps(layout::stage_folder(asset.folder, "normals"), low);
  ErrorSampling sampling;
  sampling.pixels = static_cast<std::size_t>(settings.error_samples);
  if (settings.error_pixels > 0) sampling.pixel_size = bounding_box(high).sides().maxCoeff() / settings.error_pixels;
  sampling.seed = static_cast<std::uint64_t>(run.seed);
  const TriangleMesh seen_low = plain.opacity_file.empty() ? low : cut_by_map(low, asset.prt() / plain.opacity_file);
  return error_causes({.high = high,
                       .low = seen_low,
                       .scene = scene,
                       .asset = plain,
                       .compressed = compressed ? &*compressed : nullptr,
                       .detail = detail,
                       .bake_directions = directions_of(asset.record("bake")),
                       .bounces = error_bounces(asset, settings),
                       .prior = prior_of(settings, reference_bands(plain.bands)),
                       .sampling = sampling},
                      part_of(run.progress, 1 - split_share, 1));
}

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

}  // namespace

Comparison compare_with_reference(const AssetFolder& asset, const fs::path& high_file, const ReportSettings& settings,
                                  const ComparisonRun& run) {
  Comparison comparison;
  const double albedo = settings.albedo_factor(has_albedo(asset));
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
  const TriangleMesh atlas = load_atlas(asset.prt() / layout::atlas_mesh);
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
  } else {
    view.surface_albedo = load_albedo(imported, material_of(asset.record("normals"))).albedo;
  }
  cut_occluder(high, view.surface_albedo, load_opacity(imported, material_of(asset.record("normals"))).opacity,
               high_file.string());
  view.bounces = static_cast<int>(bounces_taken(asset.record("bake")));
  view.scene = scene_of(asset, imported, view.bounces > 0 || error_bounces(asset, settings) > 0);
  view.bands = asset.baked.bands;
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
  comparison.error_left_out = left_out(asset);
  if (comparison.error_left_out.empty()) comparison.error = split_error(asset, atlas, high, view.scene, settings, run);
  comparison.predicted = settings.predictions();
  comparison.reference_seconds = reference_watch.seconds();
  comparison.silhouette_difference =
      silhouette_difference(comparison.lights.front().asset, comparison.lights.front().reference);
  return comparison;
}

}  // namespace kiln
