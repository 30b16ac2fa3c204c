// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "image/image.h"
#include "mesh/placement.h"
#include "runtime/draw/asset_renderer.h"
#include "runtime/draw/frame.h"
#include "runtime/draw/scene_view.h"
#include "runtime/draw/technique.h"
#include "runtime/light/scene_lights.h"

namespace kiln {

/// One asset in a scene.
struct SceneAsset {
  AssetRenderer* renderer = nullptr;
  Placement placement;
  Technique technique = Technique::textured_prt;
  /// Light where the asset stands, shadowed by what kiln-probes was given; null: unshadowed.
  const ProbeSet* probes = nullptr;
  /// Light at this place, for an asset that stands at several; null: that which the renderer was given last.
  std::shared_ptr<const UploadedLight> light = nullptr;
};

/// Lists the vertices of all assets, placed in the scene.
std::vector<Eigen::Vector3f> scene_shape(const std::vector<SceneAsset>& assets);

/// Gives every asset that has none of its own the light at its place.
void light_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SurfaceLook& look);

/// Draws lit assets into `frame` as `clip_from_scene` and `eye_scene` see them. Deferred shading needs an `appearance`
/// of the same size; forward shading needs none. Throws WrongUsage for a technique that deferred shading does not
/// support, and as AssetRenderer::prepare does.
void draw_scene(const std::vector<SceneAsset>& assets, const Eigen::Matrix4d& clip_from_scene,
                const Eigen::Vector3d& eye_scene, const Frame& frame, const AppearanceFrame* appearance = nullptr);

/// Lights and draws a scene in tiles; assets with a light of their own keep it. Returns linear exit radiance RGB times
/// coverage, and coverage, rows from the bottom, box-filtered. Radiance may be below 0 where truncated harmonics ring.
Image<float> render_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SceneView& view);

}  // namespace kiln
