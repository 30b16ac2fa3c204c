// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "import/import_mesh.h"
#include "material/surface_albedo.h"
#include "material/surface_opacity.h"
#include "material/surface_share.h"
#include "normals/material_ids.h"
#include "normals/normals_settings.h"

namespace kiln {

/// What the high mesh's file says of its surface besides its shape.
struct HighMaterials {
  SurfaceAlbedo albedo = {};
  SurfaceOpacity opacity = {};
  MaterialIds ids = {};                      ///< only where a map of them is asked for
  SurfaceShare roughness = SurfaceShare(1);  ///< the same, and the following
  SurfaceShare metalness = SurfaceShare(0);
  SurfaceAlbedo emission = SurfaceAlbedo::constant({0, 0, 0});  ///< light that it gives off, linear

  std::vector<std::filesystem::path> files = {};  ///< files that were read besides the mesh
  std::vector<std::string> warnings = {};         ///< sentences without a full stop
};

/// Loads what maps are made of: albedo and opacity always, the rest where `settings` ask for its maps. Throws BadInput
/// for pictures that are missing or not understood.
HighMaterials load_high_materials(const ImportedMesh& high, const NormalsSettings& settings);

}  // namespace kiln
