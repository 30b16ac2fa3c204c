#pragma once

#include <filesystem>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Bits per component (positions and uvs: of the box they fill). 16 bits of position are 1/65,535 of the box's longest
/// side.
struct DracoQuantisation {
  int position_bits = 16;
  int uv_bits = 16;
  int normal_bits = 12;
};

/// Writes positions and, where the mesh has them, normals and uvs. Vertices keep being split where they were; their
/// order and that of the triangles may change, so whoever measures the result loads it again.
void save_draco(const std::filesystem::path& file, const TriangleMesh& mesh,
                const DracoQuantisation& quantisation = {});

/// Reads what save_draco wrote, vertices and triangles as they are in the file. Throws BadInput for anything else.
TriangleMesh load_draco(const std::filesystem::path& file);

/// load_draco for an atlas: throws BadInput where the mesh has no uvs or one of them lies outside the unit square.
TriangleMesh load_atlas(const std::filesystem::path& file);

}  // namespace kiln
