// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "import/import_settings.h"
#include "import/source_mesh.h"

namespace kiln {

// One reader per format, for all stages. Each throws BadInput that names the file, the line or element, what was found,
// what was expected and what to do; "truncated" appears only for files that end too early. What a reader ignores is in
// `warnings`. Positions are read in double.

/// Remedy that most faults of mesh files have.
inline constexpr char export_again[] = "export the mesh again";

SourceMesh read_obj(const std::filesystem::path& file);
SourceMesh read_ply(const std::filesystem::path& file);
SourceMesh read_stl(const std::filesystem::path& file);
SourceMesh read_off(const std::filesystem::path& file);
SourceMesh read_drc(const std::filesystem::path& file);
SourceMesh read_gltf(const std::filesystem::path& file);  ///< .gltf and .glb
SourceMesh read_fbx(const std::filesystem::path& file);

/// Reads a mesh by its extension: obj, ply, stl, off, drc, gltf, glb or fbx, in any case of letters.
SourceMesh read_source_mesh(const std::filesystem::path& file);

/// Turns a place or direction of a file such that `up` becomes +Y, without mirroring.
Eigen::Vector3d turned_upright(const Eigen::Vector3d& place, UpAxis up);

/// Converts coordinates and normals to our axes and units, as `settings` say.
void turn_and_scale(SourceMesh& source, const ImportSettings& settings);

}  // namespace kiln
