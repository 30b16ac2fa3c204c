#include "atlas/atlas.h"
#include "atlas/drawing.h"
#include "base/command_line.h"
#include "image/image_file.h"
#include "mesh/draco_file.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-atlas", [&] {
    // Parse.
    CommandLine command("kiln-atlas",
                        "Cuts a mesh into charts, flattens them and packs them into a square texture atlas.");
    std::filesystem::path low_file, atlas_file;
    AtlasSettings settings;
    command.input("LOW", low_file, "The mesh, a Draco file (low.drc of kiln-simplify)");
    command.output(atlas_file, "The mesh with uvs, a Draco file; atlas.png and atlas.json are written beside it");
    command.options("Atlas", atlas_options(settings));
    command.parse(argc, argv);
    settings.seed = command.seed();

    // Load.
    const TriangleMesh low = load_draco(low_file);
    OutputSet outputs(folder_of(atlas_file));

    // Run.
    const AtlasResult result = make_atlas(low, settings, low_file.string(), command.progress("atlas"));

    // Save, and measure what was saved.
    const WrittenAtlas written = write_atlas(outputs.add(atlas_file.filename().string()), result);
    write_png(outputs.add("atlas.png"), draw_atlas(written.mesh, settings.size, settings.gutter));
    Json metrics = written.to_json();
    metrics.update(result.to_json());
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
