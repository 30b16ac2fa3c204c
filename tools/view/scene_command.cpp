// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/scene_command.h"

#include <string>
#include <vector>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "render/film/film.h"
#include "view/scene_viewer.h"

namespace kiln {

void view_scene_file(CommandLine& command, const std::filesystem::path& file, const std::filesystem::path& script,
                     const ViewerSetup& setup, const FilmSettings& film_settings) {
  for (const char* option : {"light", "ambient", "environment", "environment-rotation", "light-file", "window",
                             "compressed", "lamp", "reflectance", "sensor", "white"})
    if (command.given(option))
      throw WrongUsage(std::string(option) + ": found it beside a scene; expected it in the scene");
  if (is_sheet(setup.look) || setup.look.space == PictureSpace::texture)
    throw WrongUsage("technique all, side-by-side and space: found one with a scene; expected a picture of all of it");

  const Film film = load_film(file, setup.look.level);
  SceneViewerSetup own{file.stem().string(),
                       setup.look,
                       film_settings,
                       setup.screenshots,
                       [&command](const std::string& line) { command.say(line); },
                       command.threads()};
  use_scene_look(own.look, film.description, [&](const auto& name) { return command.given(name); });
  if (const std::string note = note_of_shaders(film.description); !note.empty()) command.say(note);
  const std::vector<ScriptStep> steps =
      script.empty() ? std::vector<ScriptStep>() : read_script(script, scene_script_words());

  const Stopwatch watch;
  SceneViewer viewer(own, film);
  if (script.empty())
    viewer.run();
  else
    viewer.run(steps);
  command.finish_without_output(command.result(watch.seconds(), viewer.metrics()));
}

}  // namespace kiln
