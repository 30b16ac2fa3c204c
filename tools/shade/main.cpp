// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/command_line.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "render/output/picture.h"
#include "shade/shade.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-shade", [&] {
    // Step 1: parse.
    CommandLine command("kiln-shade", "Draws a scene by shaders of one's own, which share the light.");
    std::filesystem::path scene_file, file;
    ShadeSettings settings;
    command.input("SCENE", scene_file, "A scene.yaml whose nodes have shaders, see docs/shaders.md");
    command.output(file, "The picture: .png, or .exr for linear float radiance as it is");
    command.options("Picture", shade_options(settings));
    command.options("Shading", shading_options(settings.shading));
    command.options("Scene", film_options(settings.film));
    command.parse(argc, argv);
    require_picture_name(file);

    // Step 2: load.
    ShadeScene scene = load_shade_scene(scene_file);
    use_scene_look(settings.picture, scene.film.description, [&](const auto& name) { return command.given(name); });
    if (const std::string note = note_of_albedo(scene); !note.empty()) command.say(note);
    settle_light(settings, scene.film.description, command.given("shadows"));
    check_shadow_backend(settings.film);
    command.also_read(scene.read_files());
    OutputSet outputs(folder_of(file));

    // Step 3: draw, and save picture after picture.
    const Stopwatch watch;
    const Json metrics = shade_to_files(outputs, file.filename().string(), scene, settings, command.threads(),
                                        command.progress("shade"));
    command.finish_without_record(outputs, command.result(watch.seconds(), metrics));
  });
}
