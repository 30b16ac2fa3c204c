#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "bake/shadow_frame.h"
#include "bake/transfer_engine.h"
#include "gpu/gl_objects.h"

namespace kiln {

/// How receivers are compared with depth maps.
enum class ShadowFilter {
  nearest,     ///< one comparison
  two_by_two,  ///< bilinear mean of 2 x 2 comparisons (percentage-closer filtering: Reeves, Salesin and Cook 1987)
};

struct ShadowMapSettings {
  int size_texels = 1024;           ///< width and height of the depth map of one direction
  double depth_bias = 0;            ///< fraction of the occluders' extent along the direction
  double normal_offset_texels = 1;  ///< how far receivers are moved along their normal, in texels of the depth map
  ShadowFilter filter = ShadowFilter::two_by_two;
  int batch_directions = 16;  ///< depth maps alive at a time; block_directions is a multiple of it
  bool layered_pass = true;   ///< all maps of a batch in one pass, where GL can; the result is the same
};

/// The depth maps of a batch of directions.
class ShadowMaps {
 public:
  ShadowMaps(const TransferScene& scene, const ShadowMapSettings& settings);

  /// Draws one map for each of at most settings.batch_directions directions. Also binds the batch's frames (views) to
  /// shader storage binding 0.
  void draw(std::span<const Eigen::Vector3f> directions);

  const GlTexture& maps() const { return maps_; }

 private:
  void draw_layers(int first, int count) const;

  int size_;
  GLsizei indices_;
  bool cull_;
  bool layered_;
  std::vector<Eigen::Vector3f> hull_;
  GlBuffer positions_;
  GlBuffer triangles_;
  GlBuffer views_;
  GlVertexArray occluders_;
  GlTexture maps_;
  GlFramebuffer framebuffer_;
  GlProgram program_;
};

}  // namespace kiln
