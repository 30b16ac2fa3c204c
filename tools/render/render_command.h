// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>

#include "lights/light_settings.h"
#include "render/film/film_settings.h"
#include "render/render.h"
#include "render/render_settings.h"

namespace kiln {

class CommandLine;

/// What a command line of kiln-render asks for.
struct RenderCommand {
  RenderPaths paths;
  std::filesystem::path output;
  LightSettings lights;
  RenderSettings settings;
  FilmSettings film;
  bool tree = false;  ///< whether the scene's tree is printed, and nothing drawn

  bool is_film() const { return paths.assets.size() == 1 && is_scene_file(paths.assets.front()); }

  /// Adds inputs and options, bound to this object.
  void add_to(CommandLine& command);

  /// Checks, after parsing, what holds for any input. Throws WrongUsage.
  void check(const CommandLine& command) const;
};

}  // namespace kiln
