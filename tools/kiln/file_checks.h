// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/errors.h"
#include "kiln/makefile.h"
#include "kiln/pipeline.h"

namespace kiln {

/// What keeps a file from being read as a mesh, as far as can be told without reading it; empty where nothing does.
std::string fault_of_mesh(const std::filesystem::path& file);

/// What fault_of_mesh() lets a file be, for messages.
inline constexpr const char* what_a_mesh_is = "a mesh file: obj, ply, stl, off, drc, gltf, glb or fbx";

/// Every file that an asset of the pipeline names and that cannot be read: its mesh, its archive and the member in it,
/// the picture of its material, and the meshes of those that stand around it.
std::vector<BadInput> file_faults(const Pipeline& pipeline, const Asset& asset);

}  // namespace kiln
