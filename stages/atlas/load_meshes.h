// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "atlas/atlas_settings.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Loads the mesh that is to get an atlas, with normals and the uvs that it has, and with vertices split so that hard
/// edges become seams. A Draco file is taken as it is, with both sets of uvs; others are read by import_mesh, or by
/// load_uv_mesh where `settings.uv` is to keep them. Adds to `warnings` what the file has and Kiln does not use. Throws
/// BadInput.
TriangleMesh load_low_mesh(const std::filesystem::path& file, const AtlasSettings& settings,
                           std::vector<std::string>& warnings);

/// Loads the high mesh into the frame of the low one. Adds to `warnings` likewise. Throws BadInput.
TriangleMesh load_high_mesh(const std::filesystem::path& file, const ImportSettings& settings, const MeshFrame& frame,
                            std::vector<std::string>& warnings);

}  // namespace kiln
