#pragma once

#include "atlas/chart.h"
#include "atlas/stretch.h"

namespace kiln {

/// Whether a flattened chart can go into the atlas: nothing flipped, not overlapping itself.
bool is_valid(const Chart& chart);

/// Flattens a chart: starts from the uvs it came with, if they are valid, else from the as-rigid-as-possible or the
/// least-squares conformal map, the one of less stretch; from a mean value map where neither is valid. Then relaxes it
/// (relax.h). Sets `uvs` and `parameteriser`; false where no way gives a valid map, the chart
/// then being unchanged. Least squares conformal maps: Levy et al. 2002; as rigid as possible: Liu et al. 2008;
/// mean value coordinates: Floater 2003; all of CGAL's Surface_mesh_parameterization.
bool parameterise(const Surface& surface, Chart& chart);

/// A quick valid map for a chart: by projection to its mean plane where nothing flips, else by mean value
/// coordinates; relaxed. False where none was found.
bool parameterise_quickly(const Surface& surface, Chart& chart);

}  // namespace kiln
