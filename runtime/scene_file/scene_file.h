// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>

#include "base/json_fwd.h"
#include "runtime/scene/scene_description.h"

namespace kiln {

/// Reads scene.yaml (docs/scenes.md). Paths in it are relative to its folder. Throws BadInput, which names the line,
/// for what is no scene: among others for assets, meshes and shaders that do not exist, whose content is not read.
SceneDescription load_scene(const std::filesystem::path& file);

/// Throws BadInput, which names the line, where a node has a mesh without transfer: only shaders of one's own draw it.
void require_transfer(const SceneDescription& scene);

/// Makes the JSON Schema of such a file.
Json scene_schema();

}  // namespace kiln
