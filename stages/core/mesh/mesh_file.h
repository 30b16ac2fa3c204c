#pragma once

#include <filesystem>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// What loading had to mend; all zero for a clean file.
struct LoadRepairs {
  int merged_vertices = 0;        ///< vertices at the very same place, made one (STL has nothing else)
  int dropped_triangles = 0;      ///< with a repeated vertex, without area, or there already
  int unused_vertices = 0;        ///< in no triangle
  int triangulated_polygons = 0;  ///< faces of more than three corners
};

/// Reads a high mesh: OBJ, PLY (ascii or binary), STL, OFF or Draco, by the file's extension. Polygons are
/// triangulated, identical vertices merged, empty triangles dropped; normals are computed from the faces. Throws
/// BadInput for a missing, empty, truncated or unknown file, for no faces and for coordinates that are not finite.
TriangleMesh load_mesh(const std::filesystem::path& file, LoadRepairs* repairs = nullptr);

}  // namespace kiln
