#include "base/command_line.h"
#include "base/errors.h"
#include "gpu/egl_context.h"
#include "render/render.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-render", [&] {
    // Parse.
    CommandLine command("kiln-render", "Draws baked assets under lights in spherical harmonics.");
    RenderPaths paths;
    std::filesystem::path file;
    LightSettings lights;
    RenderSettings settings;
    command.inputs("PRT", paths.assets, "Output folders of kiln-bake or kiln-compress; nothing else is read");
    command.output(file, "The picture: .png, or .exr for linear float radiance as it is");
    command.input_option("compressed", paths.compressed,
                         "The only asset as kiln-compress made it, for --technique compressed and all");
    command.list_option(
        "place", paths.places, "Picture",
        "Where an asset stands, once for each in their order: X,Y,Z[,AZIMUTH[,SCALE]], object units and "
        "degrees about +Y (default the origin)");
    command.list_option(
        "light", lights.lights, "Light",
        "A light, degrees: AZIMUTH,ELEVATION[,R,G,B] (0,0 is +Z; 90,0 is +X; a white surface that faces "
        "it has radiance 1, or R,G,B), cone:AZIMUTH,ELEVATION,HALF-ANGLE[,R,G,B], "
        "sphere:X,Y,Z,RADIUS[,R,G,B] (a ball; that radiance at the origin), "
        "hemisphere:AZIMUTH,ELEVATION,R,G,B,R,G,B (above, below) or ambient:RADIANCE; may be repeated "
        "(default 45,30 if there is no other)");
    command.input_option("environment", lights.environment,
                         "A latitude-longitude picture of radiance, EXR or HDR, or a folder of the six faces of a cube "
                         "map, px to nz");
    command.input_option("light-file", paths.light_file,
                         "All of the lights, in a JSON file (stages/relight/README.md)");
    command.options("Light", light_options(lights));
    command.options("Picture", render_options(settings));
    command.parse(argc, argv);
    if (settings.technique == TechniqueChoice::all && file.extension() != ".png")
      throw WrongUsage("output: found '" + file.string() + "'; expected a name that ends in .png for a sheet");
    require_picture_name(file);
    picture_of(settings);

    // Load.
    const RenderScene scene = load_render_scene(paths, lights, settings);
    OutputSet outputs(folder_of(file));

    // Run, and save picture after picture.
    const Stopwatch watch;
    const EglContext context(settings.gl_device, command.threads());
    const Json metrics =
        render_to_files(outputs, file.filename().string(), scene, settings, context, command.progress("render"));
    command.finish_without_record(outputs, command.result(watch.seconds(), metrics));
  });
}
