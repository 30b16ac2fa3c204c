// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <optional>

#include "mesh/camera.h"
#include "runtime/draw/technique.h"

namespace kiln {

/// The surface, as far as it is not in the transfer.
struct SurfaceLook {
  /// Linear, times the asset's own; none: 1 where the asset knows its own, else a grey of 0.8.
  std::optional<std::array<float, 3>> albedo;
  bool own_albedo = true;  ///< whether the asset's own counts
  float specular = 0;      ///< of the Phong techniques alone: reflectance of the highlight
  float shininess = 32;    ///< of these: the power of its cosine
};

/// One picture of a scene.
struct SceneView {
  Camera camera;    ///< in the scene's space
  int width = 768;  ///< pixels
  int height = 768;
  int supersample = 2;  ///< samples per pixel along each axis
  SurfaceLook look;
  Shading shading = Shading::forward;
};

}  // namespace kiln
