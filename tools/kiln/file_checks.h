// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"
#include "kiln/makefile.h"
#include "kiln/pipeline.h"

namespace kiln {

/// Says why a file cannot be read as a mesh, as far as can be known without reading it; empty if nothing is wrong.
std::string fault_of_mesh(const std::filesystem::path& file);

/// Description of what fault_of_mesh() accepts, for messages.
inline constexpr const char* what_a_mesh_is = "a mesh file: obj, ply, stl, off, drc, gltf, glb or fbx";

/// Lists the files that an asset of the pipeline names and that cannot be read: its mesh, its archive and the member in
/// it, the picture of its material, and the meshes that stand around it.
std::vector<BadInput> file_faults(const Pipeline& pipeline, const Asset& asset);

}  // namespace kiln
