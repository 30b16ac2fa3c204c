// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/command_line.h"
#include "base/json.h"
#include "base/stopwatch.h"
#include "lights/light_command.h"
#include "shade/shade_settings.h"
#include "view/scene_command.h"
#include "view/state/scene_state.h"
#include "view/viewer.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-view", [&] {
    // Step 1: parse.
    CommandLine command("kiln-view", "Shows a baked asset, or a scene that moves, in a window.");
    ViewerSetup setup;
    setup.look.width = 1280;
    setup.look.height = 800;
    std::filesystem::path folder, compressed, light_file, script;
    command.input("FOLDER", folder,
                  "An asset's folder with prt/ in it, an output folder of kiln-bake or kiln-compress, or a scene.yaml");
    command.input_option("compressed", compressed,
                         "The asset as kiln-compress made it, where it does not lie beside prt/");
    command.input_option("shader", setup.shader,
                         "Draws the asset by this shader of your own (docs/shaders.md), read again when it changes");
    command.input_option("script", script,
                         std::string("Does what the file says, one step a line, then closes: ") + script_grammar);
    add_light_options(command, setup.lights, light_file);
    add_lamp_options(command, setup.lamps, "Spectrum of all lights; of several, one at a time by key");
    // Leaves out options that the window decides: its GL device and its frames.
    command.options("Picture", render_options(setup.look).without({"frames", "gl-device"}));
    command.options("Window", viewer_options(setup));
    SceneCommandSettings scene_settings;
    command.options("Scene", scene_options(scene_settings));
    command.options("Scene by shaders", shading_options(scene_settings.shading));
    command.footer("Keys:\n" + key_help_text() + "\nKeys of a scene:\n" + scene_key_help_text());
    command.parse(argc, argv);
    command.also_read(lamp_files(setup.lamps));
    if (is_scene_file(folder)) return view_scene_file(command, folder, script, setup, scene_settings);

    // Step 2: load, before a window is opened, so that bad input is reported without a display, too.
    setup.say = [&](const std::string& line) { command.say(line); };
    setup.folders = find_asset_folders(folder, compressed);
    setup.lights = chosen_lights(setup.lights, light_file);
    check_shader(setup);
    ViewScene scene = load_view_scene(setup.folders, setup.lights, setup.lamps);
    first_state(scene, setup.lights, setup.look);
    const std::vector<ScriptStep> steps = script.empty() ? std::vector<ScriptStep>() : read_script(script);

    // Step 3: run.
    const Stopwatch watch;
    Viewer viewer(setup, std::move(scene), command.threads());
    if (script.empty())
      viewer.run();
    else
      viewer.run(steps);
    command.finish_without_output(command.result(watch.seconds(), viewer.metrics()));
  });
}
