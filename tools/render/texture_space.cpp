// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/texture_space.h"

#include <array>

#include "base/errors.h"
#include "base/json.h"
#include "runtime/decode/plane_weights.h"
#include "runtime/draw/asset_uploads.h"

namespace kiln {

namespace {

/// Returns the share of light that a texel reflects.
std::array<float, 3> albedo_at(const PrtAsset& asset, const SurfaceLook& look, std::size_t texel) {
  const bool counts = asset.albedo.known && look.own_albedo;
  const float otherwise = counts ? 1 : unknown_albedo;
  std::array<float, 3> albedo = look.albedo.value_or(std::array<float, 3>{otherwise, otherwise, otherwise});
  if (!counts) return albedo;
  const Eigen::Vector3f own = asset.albedo.at(texel);
  for (int c = 0; c < 3; ++c) albedo[c] *= own[c];
  return albedo;
}

}  // namespace

Image<float> relit_atlas(const PrtAsset& asset, const SceneLights& lights, const SurfaceLook& look) {
  if (asset.is_per_vertex())
    throw WrongUsage("space: found texture, of " + asset.ranges_file.parent_path().string() +
                     ", whose transfer stands at vertices; expected an asset with planes");
  if (lights.is_local())
    throw WrongUsage(
        "space: found texture, with a light near the asset; expected lights that are the same all over it");
  const Image<float> white = relight_texels(asset, lights.incident(asset.bands, Eigen::Vector3d::Zero()), {1, 1, 1});
  Image<float> picture(asset.width, asset.height, 4, 1.f);
  for (int j = 0; j < asset.height; ++j)
    for (int i = 0; i < asset.width; ++i) {
      const std::array<float, 3> albedo = albedo_at(asset, look, static_cast<std::size_t>(j) * asset.width + i);
      for (int c = 0; c < 3; ++c) picture.at(i, j, c) = albedo[c] * white.at(i, j, c);
    }
  return picture;
}

Json texture_metrics(const PrtAsset& asset, const std::vector<LightSpec>& lights) {
  Json texts = Json::array();
  for (const LightSpec& light : lights) texts.push_back(to_text(light));
  return {{"space", "texture"},   {"width", asset.width},       {"height", asset.height}, {"lights", texts},
          {"bands", asset.bands}, {"channels", asset.channels}, {"bits", asset.bits}};
}

}  // namespace kiln
