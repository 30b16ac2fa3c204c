#pragma once

#include "base/options.h"
#include "import/import_settings.h"

namespace kiln {

/// How much time cutting and packing may take: seconds, or what makes the most of the atlas.
enum class AtlasQuality { standard, best };

/// Whether all charts have the same scale, or those more texels on which transfer varies more (density.h).
enum class AtlasDensity { even, transfer };

struct AtlasSettings {
  Extent size = 512;           ///< of the atlas, texels
  double texels_per_unit = 0;  ///< of the mesh's length; 0: as many as fit into `size`, which otherwise has no say
  AtlasDensity density = AtlasDensity::transfer;
  bool keep_uv = false;         ///< the mesh's own uvs are the atlas, if they are one
  ImportSettings import = {};   ///< of the mesh, and of the high mesh
  int gutter = 4;               ///< least number of free texels between two charts, and at the atlas's border
  double max_stretch = 1.005;   ///< L2 stretch that a chart may have; 1 is none
  double max_stretch_linf = 2;  ///< L-infinity stretch that a chart may have
  double crease = 75;           ///< degrees; a border between charts that bends more, on average, stays a seam
  int rotations = 16;           ///< angles that are tried for each chart when packing
  AtlasQuality quality = AtlasQuality::standard;
  int seed = 1;  ///< of the orders in which packing is attempted; --seed, common to all stages
};

OptionSet atlas_options(AtlasSettings& settings);

/// Throws WrongUsage where settings of size do not go together; `size_given`: somebody set `size`.
void check_size_settings(const AtlasSettings& settings, bool size_given);

}  // namespace kiln
