// SPDX-License-Identifier: MIT
#pragma once

namespace kiln {

/// Ways to shade a scene; all give the same picture.
enum class ShadingWay {
  forward,   ///< every surface is shaded when it is drawn, with everything
  deferred,  ///< every visible sample once, each shader with everything by itself, over the tiles that show it
  factored,  ///< the same, but what shaders share is done once for all samples of a tile ([Lastra 1995], figure 7)
};

/// How lights with a direction light nodes that have precomputed transfer.
enum class DirectLightBy {
  maps,      ///< as other surfaces: cosine times the light's shadow map
  transfer,  ///< as all other light, with the shadows that the light vectors have; maps shadow highlights alone
};

/// Settings of a shaded picture.
struct ShadingSettings {
  ShadingWay way = ShadingWay::factored;
  int samples = 5;            ///< a pixel, each drawn by itself, as on PixelFlow
  int shadow_size = 1024;     ///< texels a side of a shadow map
  int reflection_size = 512;  ///< texels a side of the reflection map
  DirectLightBy direct = DirectLightBy::maps;
  /// Points around each node with transfer at which its light is computed, as for place_incident_samples.
  int incident_samples = 1;
  int steps = 3;  ///< ShadingFeatures::steps
};

}  // namespace kiln
