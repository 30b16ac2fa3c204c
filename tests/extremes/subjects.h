// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "programs.h"
#include "table.h"

namespace kiln::extremes {

/// Runs of the programs, and how much time there is.
struct Bench {
  Programs programs;
  bool quick = false;  ///< the extremes alone, without what lies between them and without long ones
};

/// One asset in other units, and far from the origin.
Table measure_scale(const Bench& bench);

/// Needles, slivers, triangles without area or in the same place, smaller than a texel and larger than the atlas.
Table measure_hard_shapes(const Bench& bench);

/// Sums over 1 to 1,000,000 directions, directions along edges, and light that grazes.
Table measure_directions(const Bench& bench);

/// Ranges of planes: one value, 1e-30, 1e30; transfer near zero.
Table measure_ranges(const Bench& bench);

/// Atlases of 8 x 8 to 8,192 x 8,192 texels, and 1 to 24 bands.
Table measure_atlases(const Bench& bench);

/// Lights of 0, 1e30, infinity and NaN.
Table measure_lights(const Bench& bench);

/// Time and memory against triangles, texels and bands.
Table measure_growth(const Bench& bench);

}  // namespace kiln::extremes
