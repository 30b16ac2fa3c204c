// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

// Operations on an oriented manifold. They keep positions, in their order, and winding. Afterwards some positions may
// be unused; where unavoidable, a vertex is in several fans or an edge appears twice.

/// Removes triangles whose corners lie on one line such that their neighbours still meet: the triangle beyond the
/// longest edge is cut in two at the third corner. Drops those for which that is impossible. `origins` has one entry
/// per triangle and is kept in step. Returns how many flat triangles there were.
int remove_flat_triangles(TriangleMesh& mesh, TriangleOrigins& origins);

/// Counts the closed walks that the edges with one triangle form.
int count_border_loops(const TriangleMesh& mesh);

/// Closes holes of at most `most_edges` edges [Liepa 2003]. A loop counts as the rim of a sheet, not as a hole, where
/// its patch would have more than 0.6 times the area of the component (a hemisphere's has a half). The patches'
/// triangles get the origins of a neighbour. Returns how many were filled.
int fill_holes(TriangleMesh& mesh, TriangleOrigins& origins, int most_edges);

}  // namespace kiln
