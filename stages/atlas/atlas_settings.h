#pragma once

#include "base/options.h"

namespace kiln {

struct AtlasSettings {
  int size = 512;               ///< width and height of the atlas, texels
  int gutter = 4;               ///< least number of free texels between two charts, and at the atlas's border
  double max_stretch = 1.005;   ///< L2 stretch that a chart may have; 1 is none
  double max_stretch_linf = 2;  ///< L-infinity stretch that a chart may have
  double crease = 75;           ///< degrees; a border between charts that bends more, on average, stays a seam
  int rotations = 16;           ///< angles that are tried for each chart when packing
  int seed = 1;                 ///< of the orders in which packing is attempted; --seed, common to all stages
};

OptionSet atlas_options(AtlasSettings& settings);

}  // namespace kiln
