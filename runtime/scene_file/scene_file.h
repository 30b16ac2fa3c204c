// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <string>

#include "base/json_fwd.h"
#include "runtime/scene/scene_description.h"

namespace kiln {

/// Reads scene.yaml (docs/scenes.md). Paths in it are relative to its folder. Throws BadInput, which names the line,
/// for what is no scene: among others for assets, meshes and shaders that do not exist, whose content is not read.
SceneDescription load_scene(const std::filesystem::path& file);

/// Throws BadInput, which names the line, where a node has a mesh without transfer: only shaders of one's own draw it.
void require_transfer(const SceneDescription& scene);

/// Throws BadInput, which names the line and says the remedy, where a light has a lamp: renderers by red, green and
/// blue would show its colours wrong.
void require_no_lamps(const SceneDescription& scene, const std::string& remedy);

/// Makes the JSON Schema of such a file.
Json scene_schema();

}  // namespace kiln
