// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "render/render_settings.h"
#include "runtime/scene/scene_description.h"
#include "runtime/shadow/moving_shadows.h"

namespace kiln {

/// Settings of pictures of a scene that moves.
struct FilmSettings {
  double time = 0;                          ///< of the first picture, seconds
  std::optional<double> frames_per_second;  ///< nothing: the frames span the scene's duration
  bool strip = false;                       ///< whether the frames stand side by side in one picture
  ShadowMethod shadows = ShadowSettings{}.method;
  int shadow_directions = ShadowSettings{}.directions;
  ShadowBackend shadow_backend = ShadowBackend::rays;
  int shadow_texels = 64;  ///< side of the maps of ShadowBackend::gpu
};

OptionSet film_options(FilmSettings& settings);

/// Tests whether an input is a scene rather than an asset: a file that ends in .yaml or .yml.
bool is_scene_file(const std::filesystem::path& input);

/// Returns the times of the pictures, seconds: `frames` of them from the settings' time on, at a rate or, the last
/// included, to the scene's end. Throws WrongUsage where nothing moves and no rate is given.
std::vector<double> film_times(const FilmSettings& film, int frames, const SceneDescription& scene);

/// Takes from a scene its camera and its background as far as the command line leaves them to it; `is_given` tells
/// whether that has an option. Of several cameras it takes the first, or the one that --camera names; that is the first
/// afterwards, without what the command line says. Throws WrongUsage for a name that none has.
void use_scene_look(RenderSettings& settings, SceneDescription& scene,
                    const std::function<bool(const std::string&)>& is_given);

/// Throws WrongUsage for a backend of shadows that does not fit their method.
void check_shadow_backend(const FilmSettings& film);

/// Returns the settings of a camera at a time: those given, and what the scene's first camera says then.
CameraSettings camera_settings_at(const CameraSettings& settings, const SceneDescription& scene, double time);

/// Returns the shadows of the settings.
ShadowSettings shadow_settings_of(const FilmSettings& film, int threads);

/// Returns the number of incident-light samples of a scene's assets, or samples_at_vertices: as the settings say, else
/// several where something shadows or a light is local.
int film_samples_of(const RenderSettings& settings, const FilmSettings& film, const SceneDescription& scene);

}  // namespace kiln
