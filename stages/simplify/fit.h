// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Settings of fit_to_surface.
struct FitSettings {
  int rounds = 20;
  int samples = 0;  ///< points on each surface, besides vertices; 0: by the number of triangles, 100,000 at most (or
                    ///< ten times the low mesh's triangles, if that is more)
};

/// Moves the vertices and flips the edges of `low`, a manifold near `high`, so that it is nearer: in turn each sample
/// of either surface is projected to the other, and the positions that bring the pairs together along their directions
/// are solved for. Samples count the more the farther they are, so that the largest distance falls too. No triangle
/// turns over or gets thinner than a collapse may make it. `is_fixed` has an entry for each vertex of `low`: 1 where it
/// stays; edges between such vertices stay, too. The result is never farther in root mean square. After [Hoppe 1993],
/// with the projections' planes in place of their points [Chen 1992].
TriangleMesh fit_to_surface(const TriangleMesh& low, const TriangleMesh& high, std::span<const std::uint8_t> is_fixed,
                            const FitSettings& settings = {}, const ProgressFunction& progress = no_progress);

}  // namespace kiln
