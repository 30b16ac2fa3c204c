// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/split_asset.h"

#include <optional>

#include "base/asset_layout.h"
#include "base/errors.h"
#include "base/json.h"
#include "material/cut_out.h"
#include "material/measured_reflectance.h"
#include "mesh/uv_raster.h"
#include "report/recorded_scene.h"
#include "scatter/subsurface_settings.h"
#include "sh/directions.h"
#include "sh/light_prior.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Returns the directions of the bake; none where it has no shadows.
std::vector<Eigen::Vector3f> directions_of(const Json& bake) {
  const Json& settings = bake.at("settings");
  if (settings.value("shadows", std::string("cast")) == "none") return {};
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

/// Stands texels on the low mesh, as a bake with receivers there does.
void stand_on_low(DetailMaps& detail, const TriangleMesh& atlas, bool own_normals) {
  const UvRaster raster = rasterise_uvs(atlas, detail.width, detail.height);
  for (int j = 0; j < detail.height; ++j)
    for (int i = 0; i < detail.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const Eigen::Vector3f position = interpolate(atlas, atlas.positions, source),
                            normal = interpolate(atlas, atlas.normals, source).normalized();
      for (int c = 0; c < 3; ++c) {
        detail.position.at(i, j, c) = position[c];
        if (own_normals) detail.normal_object.at(i, j, c) = normal[c];
      }
    }
}

/// Tells whether a bake with receivers on the low mesh was given no maps, so that their normals are that mesh's own.
bool has_no_maps(const AssetFolder& asset) {
  const std::string ship = asset.record("bake").at("settings").value("ship", std::string());
  return asset.baked.normals_file.empty() && ship.find("normal=none") == std::string::npos;
}

}  // namespace

std::vector<LightSpec> parse_lights(const std::string& option, const std::vector<std::string>& texts) {
  std::vector<LightSpec> specs;
  specs.reserve(texts.size());
  for (const std::string& text : texts) specs.push_back(parse_light_spec(text));
  if (specs.empty()) throw WrongUsage(option + ": found none; expected at least one, as in '45,30; ambient:1'");
  return specs;
}

ErrorSplit split_error(const AssetFolder& asset, const TriangleMesh& low, const HighScene& high,
                       const ReportSettings& settings, const ComparisonRun& run, const ProgressFunction& progress) {
  const Json& bake = asset.record("bake");
  const PrtAsset plain = load_prt_asset(asset.prt());
  std::optional<PrtAsset> compressed;
  if (!asset.compressed.empty()) compressed = load_prt_asset(asset.compressed);
  std::optional<DetailMaps> detail;
  if (!asset.is_per_vertex()) detail = load_detail_maps(layout::stage_folder(asset.folder, "normals"), low);
  const TriangleMesh seen_low = plain.opacity_file.empty() ? low : cut_by_map(low, asset.prt() / plain.opacity_file);
  SplitInput input = {.high = high.mesh,
                      .low = seen_low,
                      .scene = high.scene,
                      .asset = plain,
                      .compressed = compressed ? &*compressed : nullptr,
                      .detail = detail ? &*detail : nullptr,
                      .bake_directions = directions_of(bake),
                      .bounces = error_bounces(asset, settings),
                      .prior = prior_of(settings, reference_bands(plain.bands))};
  input.sampling.pixels = static_cast<std::size_t>(settings.error_samples);
  if (settings.error_pixels > 0)
    input.sampling.pixel_size = bounding_box(high.mesh).sides().maxCoeff() / settings.error_pixels;
  input.sampling.seed = static_cast<std::uint64_t>(run.seed);
  input.try_others = settings.error_others && plain.opacity_file.empty();

  // Step 1: follow what the bake has had otherwise: receivers, light beneath the surface, albedo.
  std::optional<SceneMesh> low_scene;
  std::optional<DetailMaps> low_detail;
  std::optional<LowReceivers> on_low;
  if (is_on_low(asset)) {
    if (detail) stand_on_low(low_detail.emplace(*detail), low, has_no_maps(asset));
    if (!high_casts_shadows(asset))
      low_scene =
          scene_of(asset, import_mesh(asset.folder / (detail ? layout::atlas_mesh : layout::low_mesh), {}, low.frame),
                   input.bounces > 0);
    on_low.emplace(LowReceivers{low_scene ? *low_scene : high.scene, low_detail ? &*low_detail : nullptr});
    input.on_low = &*on_low;
  }
  if (const SubsurfaceSettings subsurface = settings_of(bake, add_subsurface_options); subsurface.wanted()) {
    input.scattering = subsurface_profiles(subsurface);
    input.mm_per_unit = subsurface.mm_per_unit;
  } else if (input.albedo_within = bake.at("settings").value("bake-albedo", false);
             input.albedo_within || !plain.albedo.file.empty()) {
    input.albedo = &high.albedo;
    if (const auto albedo = constant_albedo(material_of(bake)); albedo && detail) {
      detail->albedo = {};
      detail->constant_albedo = *albedo;
    }
    input.map_albedo = !has_no_maps(asset);
  }

  // Step 2: measure.
  return error_causes(input, progress);
}

}  // namespace kiln
