// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>

#include "asset/prt_asset.h"
#include "mesh/camera.h"
#include "runtime/draw/frame.h"
#include "runtime/light/scene_lights.h"
#include "runtime/shading/shaded_renderer.h"

namespace kiln {

/// An asset drawn by a shader of one's own. Needs the GL context in which it was made.
class ShadedView {
 public:
  /// Reads and compiles the shader. Throws BadInput, which names its file and line, and as ShadedRenderer does. An
  /// asset without planes, or with several clusters of them, has irradiance in place of its transfer.
  ShadedView(const PrtAsset& asset, const std::filesystem::path& shader);

  /// Draws into a frame, one sample for each of its own. `seconds` is what the shader knows as `time`.
  void draw(const SceneLights& lights, const Camera& camera, const Frame& frame, double seconds);

 private:
  ShadedRenderer renderer_;
  std::optional<ShadedFrame> frame_;
  int drawn_ = 0;
};

}  // namespace kiln
