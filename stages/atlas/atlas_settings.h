// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "base/extent.h"
#include "base/options.h"
#include "import/import_settings.h"

namespace kiln {

/// Time spent on cutting and packing: seconds, or as long as the atlas still gains.
enum class AtlasQuality { standard, best };

/// Density of charts: the same scale for all, or more texels where transfer varies more (density.h).
enum class AtlasDensity { even, transfer };

/// Whose uvs are the atlas: those of the mesh where they form one, those of the mesh or an error, or new ones.
enum class UvChoice { automatic, keep, make };

struct AtlasSettings {
  Extent size = 512;  ///< size of the atlas, texels
  double texels_per_unit =
      0;  ///< texels per unit of the mesh's length, which overrides `size`; 0: as many as fit into `size`
  AtlasDensity density = AtlasDensity::transfer;
  UvChoice uv = UvChoice::automatic;
  ImportSettings import = {};   ///< how the mesh, and the high mesh, are read
  int gutter = 4;               ///< least number of free texels between two charts, and at the atlas's border
  double max_stretch = 1.005;   ///< largest L2 stretch of a chart; 1 is none
  double max_stretch_linf = 2;  ///< largest L-infinity stretch of a chart
  double crease = 75;           ///< degrees; a border between charts whose mean bend is larger stays a seam
  int rotations = 16;           ///< angles tried for each chart when packing
  AtlasQuality quality = AtlasQuality::standard;
  int seed = 1;  ///< for the orders in which packing is attempted; --seed, common to all stages
};

OptionSet atlas_options(AtlasSettings& settings);

/// Throws WrongUsage where settings of size contradict each other; `size_given`: `size` was set by the user.
void check_size_settings(const AtlasSettings& settings, bool size_given);

}  // namespace kiln
