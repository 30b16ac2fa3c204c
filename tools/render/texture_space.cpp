// SPDX-License-Identifier: GPL-3.0-or-later
#include "render/texture_space.h"

#include <array>

#include "base/errors.h"
#include "image/srgb.h"
#include "runtime/decode/plane_weights.h"

namespace kiln {

namespace {

constexpr float unknown_albedo = 0.8f;  // as in AssetRenderer

/// Returns the albedo of a texel.
std::array<float, 3> albedo_at(const PrtAsset& asset, const SurfaceLook& look, int i, int j) {
  const PrtAlbedo& own = asset.albedo;
  const bool counts = own.known && look.own_albedo;
  const float otherwise = counts ? 1 : unknown_albedo;
  std::array<float, 3> albedo = look.albedo.value_or(std::array<float, 3>{otherwise, otherwise, otherwise});
  for (int c = 0; counts && c < 3; ++c)
    albedo[c] *=
        own.picture.width() > 0 ? linear_from_srgb(static_cast<float>(own.picture.at(i, j, c)) / 255) : own.constant[c];
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
      const std::array<float, 3> albedo = albedo_at(asset, look, i, j);
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
