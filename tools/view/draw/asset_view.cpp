// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/draw/asset_view.h"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "runtime/draw/scene_renderer.h"

namespace kiln {

namespace {

constexpr float edge_width_pixels = 1.1f;

/// Returns the technique that a coefficient is decoded by.
Technique decoding_technique(Technique technique, const PrtAsset& main) {
  const bool has_transfer = technique != Technique::phong && technique != Technique::normal_map;
  return has_transfer ? technique : natural_technique(main);
}

/// Finds the lowest and highest value of every coefficient by decoding all texels.
std::vector<std::pair<double, double>> decoded_ranges(const PrtAsset& asset) {
  const std::size_t length = asset.vector_length();
  std::vector<std::pair<double, double>> ranges(length, {1e30, -1e30});
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(asset.width));
  std::vector<float> vectors(texels.size() * length);
  for (int row = 0; row < asset.height; ++row) {
    std::iota(texels.begin(), texels.end(), static_cast<std::uint32_t>(row) * static_cast<std::uint32_t>(asset.width));
    decode_transfer(asset, texels, vectors);
    for (std::size_t k = 0; k < vectors.size(); ++k) {
      auto& [lowest, highest] = ranges[k % length];
      lowest = std::min<double>(lowest, vectors[k]);
      highest = std::max<double>(highest, vectors[k]);
    }
  }
  return ranges;
}

}  // namespace

AssetView::AssetView(ViewScene scene, const RenderSettings& settings, const ViewState& state)
    : scene_(std::move(scene)),
      limits_(limits_of(scene_)),
      wanted_samples_(settings.incident_samples),
      look_(look_of(settings)) {
  if (!scene_.lights.lamps.empty()) spectral_ = std::make_unique<SpectralAssets>(assets_of(scene_.forms), scene_.lamps);
  ViewState allowed = state;
  limit(allowed, limits_);
  renderer(scene_.forms.of(allowed.technique), allowed.light).prepare(allowed.technique);
}

AssetRenderer& AssetView::renderer(const PrtAsset& asset, const LightChoice& choice) {
  RenderSettings wanted;
  wanted.incident_samples = wanted_samples_;
  const int samples = incident_samples_of(wanted, lights_of(choice, scene_.lights).is_local());
  std::unique_ptr<AssetRenderer>& found = renderers_[&asset];
  // A small mesh has fewer points than were asked for; its light need not be computed again for that.
  if (!found || samples != lit_samples_) {
    if (samples != lit_samples_) {
      for (auto& [other, renderer] : renderers_) renderer.reset();
      lights_.clear();
      lit_samples_ = samples;
    }
    found = std::make_unique<AssetRenderer>(asset, samples);
  }
  return *found;
}

SceneLights AssetView::lit_scene(const LightChoice& choice) {
  SceneLights lights = lights_of(choice, scene_.lights);
  if (!spectral_) return lights;
  spectral_->set_sensor(choice.other_sensor ? std::filesystem::path() : scene_.lamps.sensor);
  LampScene made = spectral_->under(std::move(lights), spectra_of(choice, scene_.lights));
  for (std::size_t k = 0; k < made.assets.size(); ++k) colors_[made.assets[k].get()] = made.colors[k];
  return std::move(made.lights);
}

const AssetLight& AssetView::light(const LightChoice& choice, int bands, const AssetRenderer& renderer) {
  if (!(choice == lit_by_)) {
    lights_.clear();
    lit_by_ = choice;
  }
  const auto found = lights_.find(bands);
  if (found != lights_.end()) return found->second;
  const AssetLight made = light_for_asset(lit_scene(choice), bands, renderer.asset(), renderer.samples());
  return lights_.emplace(bands, made).first->second;
}

void AssetView::draw_lit(const ViewState& state, Technique technique, int bands, const Camera& camera, Canvas& canvas,
                         const Frame& frame) {
  AssetRenderer& used = renderer(scene_.forms.of(technique), state.light);
  SurfaceLook look = look_;
  if (state.show == Show::coefficient) {
    look.albedo = std::array{1.f, 1.f, 1.f};
    look.own_albedo = false;
    used.set_colors(nullptr);
    used.set_light(light_of_coefficient(state.coefficient, used.asset(), used.samples()), look);
  } else {
    const AssetLight& lit = light(state.light, bands, used);
    used.set_colors(spectral_ ? colors_.at(&used.asset()) : nullptr);
    used.set_light(lit, look);
  }
  const bool is_deferred = state.shading == Shading::deferred && can_defer(technique);
  draw_scene({{&used, {}, technique}}, camera.clip_from_object().cast<double>(), camera.position.cast<double>(), frame,
             is_deferred ? &canvas.appearance() : nullptr);
}

void AssetView::draw(const ViewState& state, const Camera& camera, Canvas& canvas) {
  const Eigen::Matrix4f clip_from_object = camera.clip_from_object();
  const PrtAsset& main = scene_.forms.main();
  switch (state.show) {
    case Show::picture:
      if (shaded_) {
        shaded_->draw(lights_of(state.light, scene_.lights), camera, canvas.picture(), 0);
        break;
      }
      draw_lit(state, state.technique, state.bands, camera, canvas, canvas.picture());
      break;
    case Show::coefficient:
      draw_lit(state, decoding_technique(state.technique, main), state.bands, camera, canvas, canvas.picture());
      break;
    case Show::difference:
      draw_lit(state, state.technique, state.bands, camera, canvas, canvas.picture());
      draw_lit(state, natural_technique(main), limits_.bands, camera, canvas, canvas.reference());
      break;
    case Show::normals:
      inspection().draw_normals(clip_from_object, canvas.picture());
      break;
    case Show::charts:
      inspection().draw_charts(clip_from_object, camera.position, canvas.picture());
      break;
  }
  if (state.mesh)
    inspection().draw_edges(clip_from_object, edge_width_pixels * static_cast<float>(canvas.supersample()),
                            canvas.edges());
}

Inspection& AssetView::inspection() {
  if (!inspection_) inspection_.emplace(scene_.forms.main());
  return *inspection_;
}

std::uint64_t AssetView::gpu_bytes(const ViewState& state) {
  AssetRenderer& used = renderer(scene_.forms.of(state.technique), state.light);
  used.prepare(state.technique);
  const GpuMemory memory = used.memory(state.technique);
  return memory.per_mesh + memory.per_vertex * used.asset().mesh.positions.size() + memory.indices;
}

std::pair<double, double> AssetView::coefficient_range(int coefficient, Technique technique) {
  const auto k = static_cast<std::size_t>(coefficient);
  const PrtAsset& asset = scene_.forms.of(decoding_technique(technique, scene_.forms.main()));
  if (!asset.clusters) return {asset.planes[k].range.lowest, asset.planes[k].range.highest};
  if (decoded_ranges_.empty()) decoded_ranges_ = decoded_ranges(asset);
  return decoded_ranges_[k];
}

}  // namespace kiln
