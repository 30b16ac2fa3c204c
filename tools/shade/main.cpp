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
    command.input("SCENE", scene_file, "Meshes, nodes with shaders, and lights: YAML, see docs/shaders.md");
    command.output(file, "The picture: .png, or .exr for linear float radiance as it is");
    const OptionSet options = shade_options(settings);
    command.options("Picture", options);
    command.parse(argc, argv);
    require_picture_name(file);

    // Step 2: load.
    const ShadeScene scene = load_shade_scene(scene_file);
    apply_picture(options, scene.picture, scene_file, [&](const std::string& name) { return command.given(name); });
    command.also_read(scene.read_files);
    const PictureSettings picture = picture_of(settings.picture);
    OutputSet outputs(folder_of(file));

    // Step 3: draw, and save.
    const Stopwatch watch;
    Json metrics;
    const Image<float> radiance = draw_shade_scene(scene, settings, command.threads(), metrics);
    const double seconds = watch.seconds();
    write_picture(outputs.add(file.filename().string()), radiance, picture);
    command.finish_without_record(outputs, command.result(seconds, metrics));
  });
}
