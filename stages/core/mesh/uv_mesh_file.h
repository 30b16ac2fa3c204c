#pragma once

#include <filesystem>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Reads a mesh with the texture coordinates that it has: OBJ (`vt`) or Draco, by the file's extension. Corners of the
/// same place and uv become one vertex; polygons are triangulated; normals are the Draco file's, else computed from the
/// faces, the same on both sides of a seam. Nothing is repaired or dropped: triangles are those of the file, in its
/// order. Throws BadInput for anything else, for faces without texture coordinates, and for numbers that are not
/// finite. Uvs may lie outside the unit square.
TriangleMesh load_uv_mesh(const std::filesystem::path& file);

/// Sets `normals` to those of compute_vertex_normals as if vertices at the same place were one.
void compute_seamless_normals(TriangleMesh& mesh);

}  // namespace kiln
