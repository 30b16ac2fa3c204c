// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "atlas/chart.h"
#include "atlas/stretch.h"

namespace kiln {

/// Tells whether a flattened chart can go into the atlas: nothing is flipped, and it does not overlap itself.
bool is_valid(const Chart& chart);

/// Flattens a chart and relaxes it (relax.h). Starts from the uvs it came with, if they are valid, else from the
/// as-rigid-as-possible [Liu 2008] or the least-squares conformal map [Levy 2002], whichever has less stretch; from a
/// mean value map [Floater 2003] where neither is valid. All three are those of CGAL's Surface_mesh_parameterization.
/// Sets `uvs` and `parameteriser`; where no way gives a valid map, returns false and leaves the chart unchanged.
bool parameterise(const Surface& surface, Chart& chart);

/// Finds a quick valid map for a chart and relaxes it: projection to the chart's mean plane where nothing flips, else
/// mean value coordinates. False where neither is valid.
bool parameterise_quickly(const Surface& surface, Chart& chart);

}  // namespace kiln
