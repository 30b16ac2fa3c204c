// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "base/extent.h"
#include "base/options.h"
#include "import/import_settings.h"
#include "maps/normal_space.h"
#include "maps/seam_choice.h"
#include "material/material_settings.h"
#include "normals/map_settings.h"

namespace kiln {

/// What of the high mesh a texel may stand for.
enum class MatchChoice {
  nearest,  ///< any surface
  names     ///< surface of the parts whose names agree with that of the texel's part
};

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
  MatchChoice match = MatchChoice::nearest;
  std::string cage_mesh = {};  ///< file of an artist's cage; empty: none
  std::string part_cage = {};  ///< cages of parts, as parse_part_cages reads them

  /// Tells whether the file of an artist's low mesh is needed, for the names of its parts or the order of its faces.
  bool needs_low_file() const { return match == MatchChoice::names || !cage_mesh.empty(); }
};

/// Parses "NAME=CAGE,NAME=CAGE", names of parts and their cages, above 0 to 1; empty text has none. Throws WrongUsage.
std::vector<std::pair<std::string, double>> parse_part_cages(const std::string& text);

OptionSet normals_options(NormalsSettings& settings);

}  // namespace kiln
