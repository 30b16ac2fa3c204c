// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "base/extent.h"
#include "base/progress.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Where a level of detail ends: at this many triangles, or before anything moves farther than this.
struct LevelGoal {
  int triangles = 0;
  double error = 0;  ///< in units of the mesh; 0: no limit
};

/// Level of detail as the collapse left it.
struct Level {
  TriangleMesh mesh;                   ///< a subset of the atlas mesh's vertices
  std::vector<std::uint32_t> sources;  ///< vertex of the atlas mesh that each vertex was
  double deviation = 0;                ///< largest texture deviation of the samples, in units of the mesh
  double rms_deviation = 0;            ///< root mean square over the surface
  bool reached_goal = true;            ///< false where no further collapse was allowed
};

struct LevelLimits {
  Extent size = 512;                       ///< of the atlas, texels
  double overhang = 0;                     ///< texels that a chart may hang over its outline anywhere
  double farthest_overhang = 0;            ///< and where free texels lie nearer to it than to any other outline
  std::vector<std::uint32_t> layers = {};  ///< of the vertices: charts of different ones may overlap; empty: all of one
  bool fits = false;                       ///< whether levels are fitted to the atlas mesh (fit_to_samples)
};

/// Collapses edges of an atlas mesh, cheapest first, and returns what is left at each of the goals, each coarser than
/// the one before. A collapse moves one vertex into a neighbour, so all vertices that are left keep position, uv and
/// normal, unless levels are fitted. Seams of uvs, hard edges and borders collapse along themselves, both sides
/// together, and their junctions stay. Costs are the growth of the cubed texture deviation (texture_deviation.h).
/// Goals that cannot be reached end where nothing is left to collapse. Same input, same levels, whatever the number of
/// threads.
std::vector<Level> make_level_chain(const TriangleMesh& atlas, const std::vector<LevelGoal>& goals,
                                    const LevelLimits& limits, const ProgressFunction& progress = no_progress);

}  // namespace kiln
