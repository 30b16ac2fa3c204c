// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
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
  const ProbeSet* probes = nullptr;  ///< the light where it stands, past what kiln-probes was given; none: nothing
};

/// The vertices of all assets where they stand.
std::vector<Eigen::Vector3f> scene_shape(const std::vector<SceneAsset>& assets);

/// Gives every asset the light of its place.
void light_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SurfaceLook& look);

/// Draws lit assets into `frame` as `clip_from_scene` and `eye_scene` see them. Deferred shading goes through
/// `appearance`, which is as large; forward shading needs none. Throws WrongUsage for deferred shading of a
/// technique that does not go with it, and as AssetRenderer::prepare does.
void draw_scene(const std::vector<SceneAsset>& assets, const Eigen::Matrix4d& clip_from_scene,
                const Eigen::Vector3d& eye_scene, const Frame& frame, const AppearanceFrame* appearance = nullptr);

/// Lights and draws: linear exit radiance RGB times coverage, and coverage; rows from the bottom, box-filtered, drawn
/// in tiles. Radiance may be below 0 where truncated harmonics ring.
Image<float> render_scene(const std::vector<SceneAsset>& assets, const SceneLights& lights, const SceneView& view);

}  // namespace kiln
