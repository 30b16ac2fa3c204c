// SPDX-License-Identifier: GPL-3.0-or-later

#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "lights/light_command.h"
#include "render/render.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-render", [&] {
    // Step 1: parse.
    CommandLine command("kiln-render", "Draws baked assets under lights in spherical harmonics.");
    RenderPaths paths;
    std::filesystem::path file;
    LightSettings lights;
    RenderSettings settings;
    command.inputs("PRT", paths.assets, "Output folders of kiln-bake or kiln-compress; nothing else is read");
    command.output(file, "The picture: .png, or .exr for linear float radiance as it is");
    command.input_option("compressed", paths.compressed,
                         "The asset as kiln-compress made it, for --technique compressed");
    command.list_option("place", paths.places, "Picture",
                        "Where an asset stands, once for each in their order: X,Y,Z[,AZIMUTH[,SCALE]], degrees about "
                        "+Y (default: the first where it is, the others side by side to its right as the camera sees "
                        "them, on its ground line, a tenth of their width apart)");
    add_light_options(command, lights, paths.light_file);
    command.flag("each-light", paths.each_light, "Light",
                 "A picture for each light, NAME_000.png and so on, in place of one under all; ambient light and an "
                 "environment are in every picture");
    command.flag("each-asset", paths.each_asset, "Picture",
                 "A picture for each asset by itself, where it was baked, NAME_000.png and so on, in place of one of "
                 "all; with --each-light all lights of the first asset, then of the next");
    command.input_option("probes", paths.probes,
                         "Folder of kiln-probes: the light around the first asset, which stands at the origin, for the "
                         "others; for the only asset, that around what is not drawn");
    add_lamp_options(command, paths.lamps);
    command.options("Picture", render_options(settings));
    command.parse(argc, argv);
    command.also_read(lamp_files(paths.lamps));
    if (is_sheet(settings) && file.extension() != ".png")
      throw WrongUsage("output: found '" + file.string() + "'; expected a name that ends in .png for a sheet");
    require_picture_name(file);
    picture_of(settings);

    // Step 2: load.
    const RenderScene scene = load_render_scene(paths, lights, settings);
    if (!scene.note.empty()) command.say(scene.note);
    OutputSet outputs(folder_of(file));

    // Step 3: draw, and save picture after picture.
    const Stopwatch watch;
    const Json metrics = render_to_files(outputs, file.filename().string(), scene, settings, command.threads(),
                                         command.progress("render"));
    command.finish_without_record(outputs, command.result(watch.seconds(), metrics));
  });
}
