// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "material/scene_mesh.h"
#include "probes/probes_settings.h"

namespace kiln {

class CommandLine;

/// Loads meshes as one scene, with their albedo where light is to bounce, and adds warnings and the further files that
/// were read to `command`. Throws BadInput, also for meshes that need a frame of their own (MeshFrame), and WrongUsage
/// where light is to bounce and an albedo is not known.
SceneMesh load_probe_scene(const std::vector<std::filesystem::path>& files, const ProbesSettings& settings,
                           CommandLine& command);

}  // namespace kiln
