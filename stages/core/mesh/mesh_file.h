#pragma once

#include <filesystem>

#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Reads a high mesh: OBJ, PLY (ascii or binary), STL, OFF or Draco, by the file's extension, with the colours of its
/// vertices where an OBJ, PLY, OFF or Draco file has them. Polygons are triangulated and the mesh is repaired
/// (repair_mesh), so that every stage sees the same oriented manifold; normals are computed from the faces. Throws
/// BadInput for a missing, empty, truncated or unknown file, for no faces and for coordinates and colours that are not
/// finite.
TriangleMesh load_mesh(const std::filesystem::path& file, MeshRepairs* repairs = nullptr,
                       const MeshRepairSettings& settings = {});

}  // namespace kiln
