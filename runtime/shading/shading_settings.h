// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Ways to shade a scene; all give the same picture.
enum class ShadingWay {
  forward,   ///< every surface is shaded when it is drawn, with everything
  deferred,  ///< every visible sample once, each shader with everything by itself, over the tiles that show it
  factored,  ///< the same, but what shaders share is done once for all samples of a tile ([Lastra 1995], figure 7)
};

/// Settings of a shaded picture.
struct ShadingSettings {
  ShadingWay way = ShadingWay::factored;
  int samples = 5;            ///< a pixel, each drawn by itself, as on PixelFlow
  int shadow_size = 1024;     ///< texels a side of a shadow map
  int reflection_size = 512;  ///< texels a side of the reflection map
  int steps = 3;              ///< ShadingFeatures::steps
};

}  // namespace kiln
