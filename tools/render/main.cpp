// SPDX-License-Identifier: GPL-3.0-or-later

#include <cstdio>
#include <optional>

#include "base/command_line.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "render/film/film.h"
#include "render/film/film_lamps.h"
#include "render/lamps.h"
#include "render/render_command.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-render", [&] {
    // Step 1: parse.
    CommandLine command("kiln-render", "Draws baked assets, or a scene of them, under lights in spherical harmonics.");
    RenderCommand asked;
    asked.add_to(command);
    command.parse(argc, argv);
    command.also_read(lamp_files(asked.paths.lamps));
    asked.check(command);

    // Step 2: load.
    std::optional<Film> film;
    std::optional<RenderScene> scene;
    if (asked.is_film()) {
      film = load_film(asked.paths.assets.front(), asked.settings.level);
      use_scene_look(asked.settings, film->description, [&](const auto& name) { return command.given(name); });
      if (const std::string note = note_of_shaders(film->description); !note.empty()) command.say(note);
      light_by_lamps(*film, asked.paths.assets.front(), asked.paths.lamps, asked.settings);
      if (film->lamps) command.also_read(lamp_files({.lamps = film->lamps->names}));
    } else {
      scene = load_render_scene(asked.paths, asked.lights, asked.settings);
      if (!scene->note.empty()) command.say(scene->note);
    }
    const Stopwatch watch;
    if (asked.tree) {
      const SceneTree tree = film_tree(*film, asked.film.time);
      if (!command.json()) std::fputs(tree_text(tree).c_str(), stdout);
      command.finish_without_output(command.result(watch.seconds(), {{"tree", tree_record(tree)}}));
      return;
    }

    // Step 3: draw, and save picture after picture.
    OutputSet outputs(folder_of(asked.output));
    const std::string name = asked.output.filename().string();
    const ProgressFunction progress = command.progress("render");
    const Json metrics =
        film ? film_to_files(outputs, name, *film, asked.settings, asked.film, command.threads(), progress)
             : render_to_files(outputs, name, *scene, asked.settings, command.threads(), progress);
    command.finish_without_record(outputs, command.result(watch.seconds(), metrics));
  });
}
