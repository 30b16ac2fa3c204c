// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "normals/normals_files.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-normals", [&] {
    // Parse.
    CommandLine command("kiln-normals", "Finds the point and normal of the high mesh for every texel of an atlas.");
    std::filesystem::path high_file, atlas_file, low_file, folder;
    NormalsSettings settings;
    command.input("HIGH", high_file, "The high mesh: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.input("ATLAS", atlas_file, "The low mesh with its atlas, a Draco file of kiln-atlas");
    command.output(folder,
                   "The folder for normal.png, position.exr, coverage.png, match.png, albedo.png, opacity.png, further "
                   "--maps, and normals.json");
    command.input_option("low", low_file,
                         "Your low mesh that the atlas was made of; without it, that of simplify.json");
    command.options("Normals", normals_options(settings));
    command.parse(argc, argv);

    // Load.
    const AssetHints hints = read_asset_hints(folder_of(atlas_file));
    const TriangleMesh atlas = load_atlas(atlas_file);
    const ImportedMesh high = import_mesh(high_file, inherit(settings.import, hints.import), atlas.frame);
    const HighMaterials materials = load_high_materials(high, settings);
    command.warn(high.warnings, hints.warnings);
    command.warn(materials.warnings);
    command.also_read(materials.files);
    const MatchPlan plan = load_match_plan(settings, low_file, hints, atlas, high);
    command.also_read(plan.files);
    command.warn(plan.warnings);
    OutputSet outputs(folder);

    // Run.
    const NormalsResult result =
        make_normals(high.mesh, atlas, settings, hints, command.progress("normals"), materials, plan);

    // Save.
    Json metrics = result.to_json();
    metrics["map_files"] = write_all_maps(outputs, result, settings.maps, materials.ids);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
