// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "mesh/mesh_repair.h"
#include "mesh/triangle_mesh.h"
#include "simplify/simplify_settings.h"

namespace kiln {

/// Low mesh that a user brings, to be taken as it is.
struct OwnLow {
  TriangleMesh mesh;  ///< one normal per vertex, and one uv where the whole file has them, split at seams
  MeshRepairs repairs;
  std::vector<std::filesystem::path> files;  ///< that were read
  std::vector<std::string> warnings;         ///< each begins with the file's name
};

/// Reads the file settings.low, as settings.low_import() says, into the frame of `high`; nothing where no file is
/// named. Warnings tell repairs, uvs that are not at every corner, and a mesh that does not lie where `high` does.
/// Throws BadInput as import_mesh does, and for a mesh that lies somewhere else altogether: their shared_reach is less
/// than a tenth.
std::optional<OwnLow> load_own_low(const SimplifySettings& settings, const TriangleMesh& high);

/// Returns the share that the boxes of two meshes, in the same frame, have in common of what both reach along the axis
/// where it is least, a twentieth of the diagonal of `high` added to both; below 0 where they are apart.
double shared_reach(const TriangleMesh& low, const TriangleMesh& high);

/// Says why a low mesh hardly stands for `high`: their shared_reach is less than half. Names the settings that may mend
/// it; empty where the boxes agree.
std::string misplacement(const TriangleMesh& low, const TriangleMesh& high);

}  // namespace kiln
