#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "material/material_settings.h"
#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

struct LoadedAlbedo {
  SurfaceAlbedo albedo;
  std::vector<std::filesystem::path> files;  ///< that were read besides the mesh: material libraries and pictures
  std::size_t clamped = 0;                   ///< pixels and materials outside 0 to 1, which were clamped to that

  /// "warning: 12 pixels or materials ...", or empty.
  std::string warning() const;
};

/// The reflectance of `mesh`, which load_mesh made of `mesh_file`. With `settings.albedo` auto and no texture it is
/// that of an OBJ file's materials (Kd and map_Kd of its mtllib; a Kd of 0 beside a map_Kd is taken for absent, faces
/// without a material are white), else the mesh's colours of vertices, else white of source `none`. Materials and
/// textures follow triangles through repair by match_faces. Throws BadInput for files that are missing or not
/// understood, for materials that are not there and for textured faces without texture coordinates; WrongUsage for a
/// number and a texture at once.
LoadedAlbedo load_albedo(const std::filesystem::path& mesh_file, const TriangleMesh& mesh,
                         const MaterialSettings& settings);

}  // namespace kiln
