// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "render/render_settings.h"
#include "runtime/draw/asset_renderer.h"
#include "view/draw/canvas.h"
#include "view/draw/inspection.h"
#include "view/draw/shaded_view.h"
#include "view/files/view_scene.h"
#include "view/state/view_state.h"

namespace kiln {

/// A scene of the viewer on the GPU, drawn as a state asks. Needs the GL context in which it was made.
class AssetView {
 public:
  /// Uploads the data of the state's technique. Throws as AssetRenderer does. Takes the surface's look and the number
  /// of incident-light samples from `settings`.
  AssetView(ViewScene scene, const RenderSettings& settings, const ViewState& state);

  /// Draws pictures by a shader of one's own from now on, in place of the technique. Throws as ShadedView does.
  void set_shader(const std::filesystem::path& shader) { shaded_.emplace(scene_.forms.main(), shader); }

  const ViewScene& scene() const { return scene_; }
  const ViewLimits& limits() const { return limits_; }
  /// Returns the vertices that cameras look at.
  const std::vector<Eigen::Vector3f>& shape() const { return scene_.forms.main().mesh.positions; }

  /// Draws the picture of the canvas, with its reference if the state shows a difference and its edges if it shows
  /// them.
  void draw(const ViewState& state, const Camera& camera, Canvas& canvas);

  /// Returns the GPU memory of what was drawn last, by the state's technique.
  std::uint64_t gpu_bytes(const ViewState& state);

  /// Returns the lowest and the highest value of a transfer coefficient over the asset.
  std::pair<double, double> coefficient_range(int coefficient, Technique technique);

 private:
  AssetRenderer& renderer(const PrtAsset& asset, const LightChoice& light);
  /// Returns the lights of a choice, by spectra if there are lamps; colors_ then follow.
  SceneLights lit_scene(const LightChoice& choice);
  const AssetLight& light(const LightChoice& choice, int bands, const AssetRenderer& renderer);
  void draw_lit(const ViewState& state, Technique technique, int bands, const Camera& camera, Canvas& canvas,
                const Frame& frame);
  Inspection& inspection();

  ViewScene scene_;
  ViewLimits limits_;
  std::unique_ptr<SpectralAssets> spectral_;                                // null: RGB
  std::map<const PrtAsset*, std::shared_ptr<const SurfaceColors>> colors_;  // under the lamps of lit_by_
  int wanted_samples_;
  SurfaceLook look_;
  std::map<const PrtAsset*, std::unique_ptr<AssetRenderer>> renderers_;
  std::optional<Inspection> inspection_;
  std::optional<ShadedView> shaded_;
  std::vector<std::pair<double, double>> decoded_ranges_;  // of the compressed form
  LightChoice lit_by_;                                     // the choice that lights_ were made for
  int lit_samples_ = 0;
  std::map<int, AssetLight> lights_;  // by the number of bands used
};

}  // namespace kiln
