// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "render/film/film_settings.h"
#include "view/viewer.h"

namespace kiln {

class CommandLine;

/// Does what a parsed command line of kiln-view asks for of a scene: loads it, shows it in a window or carries out a
/// script, and finishes. Throws WrongUsage for options that are an asset's, BadInput as load_film does.
void view_scene_file(CommandLine& command, const std::filesystem::path& file, const std::filesystem::path& script,
                     const ViewerSetup& setup, const FilmSettings& film);

}  // namespace kiln
