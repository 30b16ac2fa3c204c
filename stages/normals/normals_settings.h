#pragma once

#include "base/options.h"
#include "detail/normal_space.h"

namespace kiln {

struct NormalsSettings {
  NormalSpace space = NormalSpace::object;  ///< of normal.png
  int size = 0;                             ///< texels along each side of the maps; 0: the atlas stage's, or 512
  double cage = 0;  ///< how far rays go each way, as a fraction of the high mesh's bounding box diagonal; 0: automatic
};

OptionSet normals_options(NormalsSettings& settings);

}  // namespace kiln
