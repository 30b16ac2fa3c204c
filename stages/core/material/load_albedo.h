// SPDX-License-Identifier: GPL-3.0-or-later
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
  std::vector<std::filesystem::path> files;  ///< files read besides the mesh: material libraries and pictures
  std::size_t clamped = 0;                   ///< number of pixels and materials outside 0 to 1, which were clamped
  bool beyond_rgb = false;                   ///< a measured reflectance whose colour under D65 was clamped
  bool ignores_colors = false;               ///< the mesh has vertex colours too, which its materials override

  /// Describes what was ignored or clamped: sentences without a full stop.
  std::vector<std::string> warnings() const;
};

/// Loads the reflectance of a mesh. With a measured one its albedo is that one's colour under D65. With
/// `settings.albedo` auto, and no texture, it is that of the file's materials (a
/// colour of 0 beside a texture counts as absent, and faces without a material are white), else the mesh's vertex
/// colours, else white with source `none`. Throws BadInput for materials and pictures that are missing or not
/// understood, and for textured faces without texture coordinates; WrongUsage for two of a number, a texture and a
/// measured reflectance at once.
LoadedAlbedo load_albedo(const ImportedMesh& mesh, const MaterialSettings& settings);

/// Throws WrongUsage for two of a number, a texture and a measured reflectance.
void require_one_albedo(const MaterialSettings& settings);

/// Loads the albedo that settings give for all of a surface, by a colour or by a measured reflectance; without either
/// it is white with source `none`. Throws as load_albedo does.
LoadedAlbedo load_constant_albedo(const MaterialSettings& settings);

/// Loads the light that a mesh's materials give off themselves, in place of the reflectance: linear, 0 or more, black
/// where the file has none. Throws BadInput as load_albedo does.
LoadedAlbedo load_emission(const ImportedMesh& mesh);

}  // namespace kiln
