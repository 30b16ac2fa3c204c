#include "bake/bake.h"
#include "bake/bake_files.h"
#include "base/command_line.h"

int main(int argc, char** argv) {
  return kiln::run_program("kiln-bake", [&] {
    kiln::CommandLine command("kiln-bake",
                              "Bakes spherical-harmonic transfer coefficients into the texels of an atlas.");
    kiln::BakePaths paths;
    kiln::BakeSettings settings;
    command.input("ATLAS", paths.atlas, "The low mesh with texture coordinates, of kiln-atlas");
    command.input_option("detail", paths.detail,
                         "Folder of kiln-normals: the high mesh's point and normal of every texel");
    command.input_option("occluder", paths.occluders,
                         "Mesh that casts shadows, may be repeated (default: ATLAS itself)");
    command.output(paths.output, "Folder for coeff_<c>_<ii>.png and ranges.json");
    command.options("Bake", kiln::bake_options(settings));
    command.parse(argc, argv);

    kiln::OutputSet outputs(paths.output);
    const kiln::BakeScene scene = kiln::load_bake_scene(paths, settings);
    const kiln::BakeResult result = kiln::bake(scene.receivers, scene.occluders, settings, command.seed(),
                                               command.threads(), command.progress("bake"));
    if (settings.backend == kiln::BakeBackend::egl && result.software_renderer)
      command.say("WARNING: SOFTWARE RENDERER " + result.renderer +
                  "; a GPU would be far faster, and --backend embree is likely to be");
    const kiln::Json metrics = kiln::save_bake(outputs, paths, scene, result, settings, command);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
