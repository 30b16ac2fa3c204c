#pragma once

#include "base/options.h"
#include "detail/normal_space.h"
#include "detail/seam_choice.h"
#include "import/import_settings.h"
#include "material/material_settings.h"

namespace kiln {

struct NormalsSettings {
  NormalSpace space = NormalSpace::object;  ///< of normal.png
  Extent size;                              ///< of the maps, texels; 0: the atlas stage's, or 512
  int samples = 1;                          ///< per texel: 1, 4, 16 or 64
  bool fit = false;                         ///< of one sample: what makes lookups between centres nearest
  SeamChoice seams = SeamChoice::equalise;
  MaterialSettings material = {};  ///< of the high mesh
  ImportSettings import = {};      ///< of the high mesh
  double cage = 0;  ///< how far rays go each way, as a fraction of the high mesh's bounding box diagonal; 0: automatic
};

OptionSet normals_options(NormalsSettings& settings);

}  // namespace kiln
