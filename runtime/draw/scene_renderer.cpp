// SPDX-License-Identifier: MIT
#include "runtime/draw/scene_renderer.h"

#include <algorithm>
#include <optional>

#include "base/errors.h"
#include "gpu/program.h"

namespace kiln {

namespace {

// Samples per side of a tile: pictures are drawn in tiles, so that memory does not grow with supersampling.
constexpr int tile_samples = 2048;

/// Part of a picture, in pixels.
struct Tile {
  int left = 0, bottom = 0, width = 0, height = 0;
};

/// Scales and moves clip space so that `tile` of the picture fills it.
Eigen::Matrix4d clip_of_tile(const Tile& tile, int width, int height) {
  const double across = static_cast<double>(width) / tile.width, up = static_cast<double>(height) / tile.height;
  Eigen::Matrix4d zoom = Eigen::Matrix4d::Identity();
  zoom(0, 0) = across;
  zoom(1, 1) = up;
  zoom(0, 3) = across - 1 - 2.0 * tile.left / tile.width;
  zoom(1, 3) = up - 1 - 2.0 * tile.bottom / tile.height;
  return zoom;
}

/// Averages squares of `factor` x `factor` samples of `fine`, and adds the means to the pixels of `tile`, which are 0.
void box_filter(const Image<float>& fine, int factor, const Tile& tile, Image<float>& picture) {
  const float weight = 1.f / static_cast<float>(factor * factor);
  for (int j = 0; j < fine.height(); ++j)
    for (int i = 0; i < fine.width(); ++i)
      for (int channel = 0; channel < fine.channels(); ++channel)
        picture.at(tile.left + i / factor, tile.bottom + j / factor, channel) += weight * fine.at(i, j, channel);
}

bool has_several_samples(const std::vector<SceneAsset>& assets) {
  return std::any_of(assets.begin(), assets.end(),
                     [](const SceneAsset& asset) { return asset.renderer->samples().count() > 1; });
}

}  // namespace

std::vector<Eigen::Vector3f> scene_shape(const std::vector<SceneAsset>& assets) {
  std::vector<Eigen::Vector3f> shape;
  for (const SceneAsset& asset : assets)
    for (const Eigen::Vector3f& vertex : asset.renderer->asset().mesh.positions)
      shape.emplace_back(asset.placement.to_scene(vertex.cast<double>()).cast<float>());
  return shape;
}

void light_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SurfaceLook& look) {
  for (const SceneAsset& asset : assets) {
    if (asset.light) continue;
    SceneLights there = lights;
    there.probes = asset.probes;
    asset.renderer->set_light(
        light_asset(there, asset.renderer->asset().bands, asset.placement, asset.renderer->samples().points), look);
  }
}

void draw_scene(const std::vector<SceneAsset>& assets, const Eigen::Matrix4d& clip_from_scene,
                const Eigen::Vector3d& eye_scene, const Frame& frame, const AppearanceFrame* appearance) {
  const auto clip_from_object = [&](const SceneAsset& asset) -> Eigen::Matrix4f {
    return (clip_from_scene * asset.placement.matrix()).cast<float>();
  };
  for (const SceneAsset& asset : assets) {
    asset.renderer->prepare(asset.technique);
    if (appearance != nullptr && asset.technique != Technique::textured_prt && asset.technique != Technique::compressed)
      throw WrongUsage("shading deferred: found technique " + technique_name(asset.technique) +
                       "; expected textured-prt or compressed, whose shading is worth deferring");
    if (appearance != nullptr && asset.renderer->samples().are_vertices())
      throw WrongUsage(
          "shading deferred: found light at vertices, which it does not keep; expected incident samples, or shading "
          "forward");
  }
  const auto use_light = [](const SceneAsset& asset) {
    if (asset.light) asset.renderer->use_light(asset.light);
  };
  if (appearance == nullptr) {
    frame.begin();
    for (const SceneAsset& asset : assets) {
      use_light(asset);
      asset.renderer->draw(asset.technique, clip_from_object(asset),
                           asset.placement.to_object(eye_scene).cast<float>());
    }
    return;
  }
  const auto number = [](std::size_t k) { return static_cast<int>(k) + 1; };
  appearance->begin(frame);
  for (std::size_t k = 0; k < assets.size(); ++k) {
    appearance->begin_asset(number(k));
    assets[k].renderer->draw_appearance(clip_from_object(assets[k]), number(k));
  }
  appearance->begin_shading(frame);
  for (std::size_t k = 0; k < assets.size(); ++k) {
    appearance->begin_shading_asset(number(k));
    use_light(assets[k]);
    assets[k].renderer->shade_appearance(number(k));
  }
  appearance->end_shading(frame);
}

Image<float> render_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SceneView& view) {
  const int factor = view.supersample;
  const int tile_side = std::max(1, tile_samples / factor);
  const int widest = std::min(tile_side, view.width), highest = std::min(tile_side, view.height);
  light_scene(assets, lights, view.look);
  Image<float> picture(view.width, view.height, 4);
  for (int bottom = 0; bottom < view.height; bottom += tile_side)
    for (int left = 0; left < view.width; left += tile_side) {
      const Tile tile{left, bottom, std::min(widest, view.width - left), std::min(highest, view.height - bottom)};
      Image<float> fine(tile.width * factor, tile.height * factor, 4);
      const Frame frame(fine.width(), fine.height());
      std::optional<AppearanceFrame> appearance;
      if (view.shading == Shading::deferred)
        appearance.emplace(fine.width(), fine.height(), has_several_samples(assets));
      draw_scene(assets, clip_of_tile(tile, view.width, view.height) * view.camera.clip_from_object().cast<double>(),
                 view.camera.position.cast<double>(), frame, appearance ? &*appearance : nullptr);
      glPixelStorei(GL_PACK_ALIGNMENT, 1);
      glReadPixels(0, 0, fine.width(), fine.height(), GL_RGBA, GL_FLOAT, fine.values().data());
      check_gl("drawing the scene");
      box_filter(fine, factor, tile, picture);
    }
  glBindFramebuffer(GL_FRAMEBUFFER, 0);
  return picture;
}

}  // namespace kiln
