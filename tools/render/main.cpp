#include "asset/prt_asset.h"
#include "base/command_line.h"
#include "gpu/egl_context.h"
#include "relight/prt_renderer.h"
#include "relight/render_metrics.h"
#include "relight/render_settings.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-render", [&] {
    // Parse.
    CommandLine command("kiln-render", "Draws a baked asset under lights in spherical harmonics.");
    std::filesystem::path folder, file;
    LightSettings lights;
    RenderSettings settings;
    command.input("PRT", folder, "The output folder of kiln-bake or kiln-compress; nothing else is read");
    command.output(file, "The picture: .png, or .exr for linear float radiance as it is");
    command.app()
        .add_option(
            "--light", lights.lights,
            "A light, degrees: AZIMUTH,ELEVATION[,R,G,B] (0,0 is +Z; 90,0 is +X; a white surface that faces it "
            "has radiance 1, or R,G,B), cone:AZIMUTH,ELEVATION,HALF-ANGLE[,R,G,B], sphere:X,Y,Z,RADIUS[,R,G,B], "
            "hemisphere:AZIMUTH,ELEVATION,R,G,B,R,G,B (above, below) or ambient:RADIANCE; may be repeated (default "
            "45,30 "
            "if there is no other)")
        ->expected(1)
        ->take_all()
        ->type_name("")
        ->group("Light");
    command.input_option("environment", lights.environment, "A latitude-longitude picture of radiance, EXR or HDR");
    command.options("Light", light_options(lights));
    command.options("Picture", render_options(settings));
    command.parse(argc, argv);
    require_picture_name(file);
    const std::vector<LightSpec> specs = light_specs(lights);
    const PictureSettings picture = picture_of(settings);

    // Load.
    const PrtAsset asset = load_prt_asset(folder);
    const PrtView view = view_of(settings, bounding_box(asset.mesh));
    const LightCoefficients light = all_lights(lights, asset.bands);
    OutputSet outputs(folder_of(file));

    // Run.
    const Stopwatch watch;
    const EglContext context(settings.gl_device, command.threads());
    const Image<float> radiance = PrtRenderer(asset).render(light, view);
    const double seconds = watch.seconds();

    // Save.
    write_picture(outputs.add(file.filename().string()), radiance, picture);
    command.finish_without_record(outputs, command.result(seconds, render_metrics(asset, specs, radiance, context)));
  });
}
