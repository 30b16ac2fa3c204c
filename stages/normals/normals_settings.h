// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/extent.h"
#include "base/options.h"
#include "import/import_settings.h"
#include "maps/normal_space.h"
#include "maps/seam_choice.h"
#include "material/material_settings.h"
#include "normals/map_settings.h"

namespace kiln {

struct NormalsSettings {
  NormalSpace space = NormalSpace::object;  ///< space of normal.png
  Extent size;                              ///< size of the maps, texels; 0: the atlas stage's, or 512
  Extent albedo_size = {};                  ///< size of albedo.png, texels; 0: that of the maps
  Extent normal_size = {};                  ///< size of the normal map that ships, texels; 0: that of the maps
  int samples = 1;                          ///< per texel: 1, 4, 16 or 64
  bool fit = false;                         ///< with one sample: fit bilinear lookups between centres, too
  SeamChoice seams = SeamChoice::equalise;
  MaterialSettings material = {};  ///< reflectance of the high mesh
  ImportSettings import = {};      ///< how the high mesh is read
  MapSettings maps = {};           ///< further maps
  double cage = 0;  ///< length of rays each way, as a fraction of the high mesh's bounding box diagonal; 0: automatic
};

OptionSet normals_options(NormalsSettings& settings);

}  // namespace kiln
