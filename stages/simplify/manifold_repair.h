#pragma once

#include "mesh/triangle_mesh.h"

namespace kiln {

/// What it took to make an oriented manifold of a mesh; all zero for one that was it already.
struct ManifoldRepairs {
  int dropped_triangles = 0;   ///< with a vertex repeated
  int reversed_triangles = 0;  ///< wound against their neighbours
  int split_vertices = 0;  ///< vertices added where more than two triangles met in an edge, or several fans in a vertex
};

/// The same surface as an oriented manifold, possibly with border: the positions and triangles of `mesh`, as they are
/// where it is one already.
TriangleMesh to_manifold(const TriangleMesh& mesh, ManifoldRepairs& repairs);

/// Whether the triangles are an oriented manifold, possibly with border.
bool is_manifold(const TriangleMesh& mesh);

}  // namespace kiln
