#pragma once

#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

// Operations on an oriented manifold. They keep positions, in their order, and winding; some positions may be unused
// then, and where there is no other way a vertex is in several fans or an edge there twice.

/// Removes the triangles whose corners lie on one line such that their neighbours still meet: the triangle beyond the
/// longest edge is cut in two at the third corner. Where that cannot be, leaves them out. `origins` has one entry per
/// triangle and is kept so. Returns how many there were.
int remove_flat_triangles(TriangleMesh& mesh, TriangleOrigins& origins);

/// How many closed walks the edges with one triangle form.
int count_border_loops(const TriangleMesh& mesh);

/// Closes holes of at most `most_edges` edges (Liepa, "Filling holes in meshes", 2003). A loop is no hole but the rim
/// of a sheet where its patch would have more than 0.6 times the area of the component (a hemisphere's has a half).
/// The patches' triangles have the origins of a neighbour. Returns how many were filled.
int fill_holes(TriangleMesh& mesh, TriangleOrigins& origins, int most_edges);

}  // namespace kiln
