// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/asset_layout.h"
#include "base/command_line.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "image/image_file.h"
#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "normals/normals.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-normals", [&] {
    // Parse.
    CommandLine command("kiln-normals", "Finds the point and normal of the high mesh for every texel of an atlas.");
    std::filesystem::path high_file, atlas_file, folder;
    NormalsSettings settings;
    command.input("HIGH", high_file, "The high mesh: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.input("ATLAS", atlas_file, "The low mesh with its atlas, a Draco file of kiln-atlas");
    command.output(folder,
                   "The folder for normal.png, position.exr, coverage.png, match.png, albedo.png, opacity.png, further "
                   "--maps, and normals.json");
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
    OutputSet outputs(folder);

    // Run.
    const NormalsResult result =
        make_normals(high.mesh, atlas, settings, hints, command.progress("normals"), materials);

    // Save.
    write_png(outputs.add(layout::normal_map), result.normal);
    if (result.own_normal)
      write_png(outputs.add(layout::own_normal_map), *result.own_normal);
    else
      outputs.remove_stale(layout::own_normal_map);
    write_exr(outputs.add(layout::position_map), result.position);
    write_png(outputs.add(layout::coverage_map), result.coverage);
    write_png(outputs.add(layout::match_map), result.match);
    if (result.albedo_map)
      write_png(outputs.add(layout::albedo_map), result.albedo_map->picture);
    else
      outputs.remove_stale(layout::albedo_map);
    if (result.opacity_map)
      write_png(outputs.add(layout::opacity_map), result.opacity_map->picture);
    else
      outputs.remove_stale(layout::opacity_map);
    Json metrics = result.to_json();
    metrics["map_files"] = write_maps(outputs, result.maps, settings.maps, materials.ids);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
