#pragma once

#include "atlas/chart.h"
#include "atlas/stretch.h"

namespace kiln {

/// Whether a flattened chart can go into the atlas: nothing flipped, not overlapping itself.
bool is_valid(const Chart& chart);

/// Flattens a chart that has no uvs yet, or better: as-rigid-as-possible and least-squares conformal maps, the valid
/// one of less stretch; a mean value map where neither is valid; the uvs the chart came with, if they are as good. Then
/// relaxes it (relax.h). Sets `uvs` and `parameteriser`; false where no way gives a valid map, the chart
/// then being unchanged. Least squares conformal maps: Levy et al. 2002; as rigid as possible: Liu et al. 2008;
/// mean value coordinates: Floater 2003; all of CGAL's Surface_mesh_parameterization.
bool parameterise(const Surface& surface, Chart& chart);

/// A quick valid map for a chart: by projection to its mean plane where nothing flips, else by mean value
/// coordinates; relaxed. False where none was found.
bool parameterise_quickly(const Surface& surface, Chart& chart);

}  // namespace kiln
