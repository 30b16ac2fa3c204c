// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/asset_layout.h"
#include "base/command_line.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "import/import_mesh.h"
#include "material/load_albedo.h"
#include "mesh/draco_file.h"
#include "normals/normals.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-normals", [&] {
    // Parse.
    CommandLine command("kiln-normals", "Finds the point and normal of the high mesh for every texel of an atlas.");
    std::filesystem::path high_file, atlas_file, low_file, folder;
    NormalsSettings settings;
    command.input("HIGH", high_file, "The high mesh: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.input("ATLAS", atlas_file, "The low mesh with its atlas, a Draco file of kiln-atlas");
    command.output(
        folder, "The folder for normal.png, position.exr, coverage.png, match.png, albedo.png, --maps, normals.json");
    command.input_option("low", low_file,
                         "Your low mesh that the atlas was made of; without it, that of simplify.json");
    command.options("Normals", normals_options(settings));
    command.parse(argc, argv);

    // Load.
    const AssetHints hints = read_asset_hints(folder_of(atlas_file));
    const TriangleMesh atlas = load_atlas(atlas_file);
    const ImportedMesh high = import_mesh(high_file, inherit(settings.import, hints.import), atlas.frame);
    const LoadedAlbedo material = load_albedo(high, settings.material);
    command.warn(high.warnings, hints.warnings);
    command.warn(material.warnings());
    command.also_read(material.files);
    const MaterialIds materials = settings.maps.kinds.empty() ? MaterialIds{} : find_material_ids(high);
    const MatchPlan plan = load_match_plan(settings, low_file, hints, atlas, high);
    command.also_read(plan.files);
    command.warn(plan.warnings);
    OutputSet outputs(folder);

    // Run.
    const NormalsResult result =
        make_normals(high.mesh, atlas, settings, hints, command.progress("normals"), material.albedo, materials, plan);

    // Save.
    write_png(outputs.add(layout::normal_map), result.normal);
    write_exr(outputs.add(layout::position_map), result.position);
    write_png(outputs.add(layout::coverage_map), result.coverage);
    write_png(outputs.add(layout::match_map), result.match);
    if (result.albedo_map)
      write_png(outputs.add(layout::albedo_map), result.albedo_map->picture);
    else
      outputs.remove_stale(layout::albedo_map);
    Json metrics = result.to_json();
    metrics["map_files"] = write_maps(outputs, result.maps, settings.maps, materials);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
