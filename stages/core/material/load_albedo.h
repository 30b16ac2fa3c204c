#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "material/material_settings.h"
#include "material/surface_albedo.h"

namespace kiln {

struct LoadedAlbedo {
  SurfaceAlbedo albedo;
  std::vector<std::filesystem::path> files;  ///< that were read besides the mesh: material libraries and pictures
  std::size_t clamped = 0;                   ///< pixels and materials outside 0 to 1, which were clamped to that
  bool ignores_colors = false;               ///< the mesh has colours of vertices too, which its materials come before

  /// Sentences without a full stop.
  std::vector<std::string> warnings() const;
};

/// The reflectance of a mesh. With `settings.albedo` auto and no texture it is that of the file's materials (a colour
/// of 0 beside a texture is taken for absent, faces without a material are white), else the mesh's colours of vertices,
/// else white of source `none`. Throws BadInput for materials and pictures that are missing or not understood, and for
/// textured faces without texture coordinates; WrongUsage for a number and a texture at once.
LoadedAlbedo load_albedo(const ImportedMesh& mesh, const MaterialSettings& settings);

}  // namespace kiln
