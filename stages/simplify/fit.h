#pragma once

#include <cstdint>
#include <span>

#include "base/progress.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

struct FitSettings {
  int rounds = 20;
  int samples = 0;  ///< of each surface, besides vertices; 0: by the number of triangles
};

/// `low`, a manifold near `high`, with its vertices moved and edges flipped so that it is nearer: in turn each sample
/// of either surface is projected to the other, and the positions that bring the pairs together along their directions
/// are solved for. Samples count the more the farther they are, so that the largest distance falls too. Nothing turns
/// over or gets thinner than a collapse may make it. `is_fixed`, of each vertex of low: those stay, and so do edges
/// between them. The result is never farther in root mean square. Hoppe, DeRose, Duchamp, McDonald and Stuetzle, "Mesh
/// optimization" (1993), with the projections' planes in place of their points (Chen and Medioni 1992).
TriangleMesh fit_to_surface(const TriangleMesh& low, const TriangleMesh& high, std::span<const std::uint8_t> is_fixed,
                            const FitSettings& settings = {}, const ProgressFunction& progress = no_progress);

}  // namespace kiln
