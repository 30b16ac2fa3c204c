// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/scene_command.h"

#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "render/film/film.h"
#include "render/film/film_lamps.h"
#include "runtime/scene_file/scene_file.h"
#include "view/scene_viewer.h"

namespace kiln {

namespace {

/// Tests whether a scene is to be drawn by its shaders.
bool is_shaded(const std::filesystem::path& file, SceneCommandSettings::By by) {
  using By = SceneCommandSettings::By;
  return by == By::automatic ? !load_scene(file).shaders.empty() : by == By::shaders;
}

}  // namespace

OptionSet scene_options(SceneCommandSettings& settings) {
  using By = SceneCommandSettings::By;
  OptionSet options = film_options(settings.film).without({"fps", "strip"});
  options.choice("by", settings.by, {{"auto", By::automatic}, {"shaders", By::shaders}, {"transfer", By::transfer}},
                 "What draws a scene: the shaders of its nodes (docs/shaders.md), or transfer and the assets' albedo; "
                 "auto: shaders, if the scene names a folder of them");
  return options;
}

void view_scene_file(CommandLine& command, const std::filesystem::path& file, const std::filesystem::path& script,
                     const ViewerSetup& setup, const SceneCommandSettings& settings) {
  for (const char* option :
       {"light", "ambient", "environment", "environment-rotation", "light-file", "window", "compressed"})
    if (command.given(option))
      throw WrongUsage(std::string(option) + ": found it beside a scene; expected it in the scene");
  if (is_sheet(setup.look) || setup.look.space == PictureSpace::texture)
    throw WrongUsage("technique all, side-by-side and space: found one with a scene; expected a picture of all of it");

  const bool by_shaders = is_shaded(file, settings.by);
  ShadeSettings shade;
  shade.shading = settings.shading;
  shade.picture = setup.look;
  shade.film = settings.film;
  Film film;
  ShadeScene shaded;
  if (by_shaders)
    shaded = load_shade_scene(file);
  else
    film = load_film(file, setup.look.level);
  SceneDescription& description = by_shaders ? shaded.film.description : film.description;
  use_scene_look(shade.picture, description, [&](const auto& name) { return command.given(name); });
  SceneViewerSetup own{file.stem().string(),
                       shade.picture,
                       settings.film.time,
                       setup.screenshots,
                       [&command](const std::string& line) { command.say(line); },
                       command.threads(),
                       {}};
  if (by_shaders) {
    for (const char* option : {"technique", "level", "shading", "specular", "shininess", "supersample", "albedo",
                               "lamp", "reflectance", "sensor", "white"})
      if (command.given(option))
        throw WrongUsage(std::string(option) +
                         ": found it beside a scene that is drawn by its shaders; expected --by "
                         "transfer");
    if (const std::string note = note_of_albedo(shaded); !note.empty()) command.say(note);
    settle_light(shade, description, command.given("shadows"));
    own.make_drawing = [&] { return drawing_by_shaders(shaded, shade, command.threads()); };
  } else {
    if (const std::string note = note_of_shaders(description); !note.empty()) command.say(note);
    light_by_lamps(film, file, setup.lamps, shade.picture);
    own.make_drawing = [&] { return drawing_by_transfer(film, shade.picture, shade.film, command.threads()); };
  }
  check_shadow_backend(shade.film);
  const std::vector<ScriptStep> steps =
      script.empty() ? std::vector<ScriptStep>() : read_script(script, scene_script_words(by_shaders));

  const Stopwatch watch;
  SceneViewer viewer(own);
  if (script.empty())
    viewer.run();
  else
    viewer.run(steps);
  command.finish_without_output(command.result(watch.seconds(), viewer.metrics()));
}

}  // namespace kiln
