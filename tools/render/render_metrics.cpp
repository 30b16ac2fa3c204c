// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/render_metrics.h"

#include <array>

#include "base/json.h"

namespace kiln {

namespace {

Json describe(const SceneAsset& drawn) {
  const PrtAsset& asset = drawn.renderer->asset();
  const GpuMemory memory = drawn.renderer->memory(drawn.technique);
  return {
      {"technique", technique_name(drawn.technique)},
      {"incident_samples", drawn.renderer->samples().count()},
      {"place", {drawn.placement.translation.x(), drawn.placement.translation.y(), drawn.placement.translation.z()}},
      {"bands", asset.bands},
      {"channels", asset.channels},
      {"bits", asset.bits},
      {"planes", asset.planes.size()},
      {"clusters", asset.clusters ? asset.clusters->count : 0},
      {"atlas_width", asset.width},
      {"atlas_height", asset.height},
      {"triangles", asset.mesh.triangles.size()},
      {"vertices", asset.mesh.positions.size()},
      {"gpu_bytes_per_mesh", memory.per_mesh},
      {"gpu_bytes_per_vertex", memory.per_vertex},
      {"gpu_bytes_indices", memory.indices}};
}

}  // namespace

Json render_metrics(const std::vector<SceneAsset>& assets, const std::vector<LightSpec>& lights,
                    const Image<float>& radiance, const EglContext& context) {
  std::array<double, 4> sums = {};
  for (std::size_t k = 0; k < radiance.values().size(); ++k) sums[k % 4] += radiance.values()[k];
  Json mean = Json::array();
  for (int c = 0; c < 3; ++c) mean.push_back(sums[3] > 0 ? sums[c] / sums[3] : 0.0);
  Json light_texts = Json::array(), drawn = Json::array();
  for (const LightSpec& light : lights) light_texts.push_back(to_text(light));
  for (const SceneAsset& asset : assets) drawn.push_back(describe(asset));
  return {{"renderer", context.renderer()},
          {"software_renderer", context.is_software()},
          {"width", radiance.width()},
          {"height", radiance.height()},
          {"lights", light_texts},
          {"coverage", sums[3] / (static_cast<double>(radiance.width()) * radiance.height())},
          {"mean_radiance", mean},
          {"assets", drawn}};
}

}  // namespace kiln
