// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "base/options.h"

namespace kiln {

/// Objects around an asset that cast shadows on it, as the command line gives them. Numbers in the scene's units.
struct Surroundings {
  std::string place = "0,0,0";  ///< place of the asset in the scene: X,Y,Z[,AZIMUTH[,SCALE]], as parse_placement
  std::string ground = "none";  ///< or HEIGHT[,HALF-SIZE] of a square plane
  std::vector<std::string> neighbours;  ///< meshes, as parse_neighbour reads them

  bool any() const { return ground != "none" || !neighbours.empty(); }
};

/// Adds `place` and `ground` to a stage's options.
void add_surroundings_options(OptionSet& options, Surroundings& surroundings);

}  // namespace kiln
