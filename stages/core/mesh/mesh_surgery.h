#pragma once

#include "mesh/triangle_mesh.h"

namespace kiln {

// Operations on an oriented manifold. They keep positions, in their order, and winding; some positions may be unused
// then, and where there is no other way a vertex is in several fans or an edge there twice.

/// Removes the triangles whose corners lie on one line such that their neighbours still meet, by CGAL's
/// remove_degenerate_faces; where that finds no way, leaves them out. Returns how many there were.
int remove_flat_triangles(TriangleMesh& mesh);

/// How many closed walks the edges with one triangle form.
int count_border_loops(const TriangleMesh& mesh);

/// Closes holes of at most `most_edges` edges (Liepa, "Filling holes in meshes", 2003). A loop is no hole but the rim
/// of a sheet where its patch would have more than 0.6 times the area of the component (a hemisphere's has a half).
/// Returns how many were filled.
int fill_holes(TriangleMesh& mesh, int most_edges);

}  // namespace kiln
