// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "base/options.h"
#include "render/film/film_settings.h"
#include "runtime/shading/shading_settings.h"
#include "view/viewer.h"

namespace kiln {

class CommandLine;

/// Settings of scenes alone.
struct SceneCommandSettings {
  enum class By { automatic, shaders, transfer };
  By by = By::automatic;
  FilmSettings film = {};
  ShadingSettings shading = {};
};

/// Options of scenes, but for those of the shading (shading_options).
OptionSet scene_options(SceneCommandSettings& settings);

/// Does what a parsed command line of kiln-view asks for of a scene: loads it, shows it in a window or carries out a
/// script, and finishes. Throws WrongUsage for options that are an asset's, BadInput as load_film and
/// load_shade_scene do.
void view_scene_file(CommandLine& command, const std::filesystem::path& file, const std::filesystem::path& script,
                     const ViewerSetup& setup, const SceneCommandSettings& settings);

}  // namespace kiln
