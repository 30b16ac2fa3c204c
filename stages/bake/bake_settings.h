#pragma once

#include <string>

#include "base/options.h"
#include "sh/directions.h"

namespace kiln {

enum class BakeBackend { egl, embree };

/// Which surface receives light: the point of the high mesh that a texel stands for, or the texel's point of the low
/// mesh.
enum class BakeReceiver { high, low };

enum class BakeShadowFilter { nearest, two_by_two };

struct BakeSettings {
  int bands = 5;  ///< bands^2 coefficients
  int directions = 1024;
  Sampling sampling = Sampling::fibonacci;
  int bits = 8;  ///< of a stored coefficient
  BakeBackend backend = BakeBackend::egl;
  BakeReceiver receiver = BakeReceiver::high;
  int size = 0;  ///< texels, where there is no detail folder to say so; 0: what the atlas was packed for
  std::string gl_device = "auto";
  int shadow_size = 1024;    ///< texels
  double shadow_bias = 0;    ///< fraction of the occluders' extent along the direction
  double normal_offset = 1;  ///< texels of the depth map
  BakeShadowFilter shadow_filter = BakeShadowFilter::two_by_two;
  double ray_offset = 1e-4;   ///< fraction of the occluders' bounding box diagonal
  int verify_directions = 0;  ///< 0: no verification
  int verify_texels = 8192;
};

/// The settings as the command line, pipeline.yaml and the report know them.
OptionSet bake_options(BakeSettings& settings);

}  // namespace kiln
