#pragma once

#include <array>

#include "asset/prt_asset.h"
#include "gpu/gl_objects.h"
#include "image/image.h"
#include "mesh/camera.h"
#include "sh/lights.h"

namespace kiln {

/// One picture of an asset.
struct PrtView {
  Camera camera;
  int width = 768;  ///< pixels
  int height = 768;
  int supersample = 2;  ///< samples per pixel along each axis
  std::array<float, 3> albedo = {0.8f, 0.8f, 0.8f};
};

/// An asset on the GPU, baked or compressed, drawn by shaders/render_prt.*. The GL context that is current at
/// construction must be current in every call and at destruction.
class PrtRenderer {
 public:
  /// Uploads mesh and planes. Throws MachineLacks where the device takes no texture of that size or number of layers.
  explicit PrtRenderer(const PrtAsset& asset);

  /// Linear exit radiance RGB times coverage, and coverage; rows from the bottom, box-filtered. Both sides of a
  /// triangle are drawn. Radiance may be below 0 where truncated harmonics ring. Throws as
  /// cluster_weights does.
  Image<float> render(const LightCoefficients& light, const PrtView& view) const;

 private:
  const PrtAsset& asset_;
  GlProgram program_;
  GlTexture planes_;
  GlTexture cluster_ids_;  ///< of assets of several clusters alone
  GlBuffer positions_, uvs_, indices_;
  GlVertexArray vertices_;
};

}  // namespace kiln
