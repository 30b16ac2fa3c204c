// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/bake_files.h"
#include "bake/bake_run.h"
#include "base/command_line.h"
#include "base/json.h"
#include "base/outputs.h"

int main(int argc, char** argv) {
  return kiln::run_program("kiln-bake", [&] {
    kiln::CommandLine command(
        "kiln-bake", "Bakes spherical-harmonic transfer coefficients into the texels of an atlas, or into vertices.");
    kiln::BakePaths paths;
    kiln::BakeSettings settings;
    kiln::BakeRun run;
    command.input("ATLAS", paths.atlas,
                  "The low mesh with texture coordinates, of kiln-atlas; with --per-vertex any mesh");
    command.input_option("detail", paths.detail,
                         "Folder of kiln-normals: the high mesh's point and normal of every texel");
    command.input_option("occluder", paths.occluders,
                         "Mesh that casts shadows, may be repeated (default: ATLAS itself)");
    command.input_option("levels", paths.levels,
                         "Folder of kiln-lod: coarser meshes that share the atlas, to ship with it");
    command.list_option(
        "neighbour", settings.surroundings.neighbours, "Bake",
        "Mesh beside the asset that casts shadows, may be repeated: FILE[;place=X,Y,Z[,AZIMUTH[,SCALE]]]"
        "[;albedo=...][;albedo-texture=...][;reflectance=...][;reflectance-of=...][;albedo-encoding=...][;opacity=...]["
        ";opacity-texture=...]"
        "[;opacity-cutoff=...][;up=...][;unit=...][;scale=...][;normals=...][;fill-holes=...]");
    command.input_option("merge", run.shards, "Folder of a shard; once for each. Adds them up in place of integrating");
    command.output(paths.output, "Folder for coeff_<c>_<ii>.png (per vertex: vertices.drc) and ranges.json");
    command.options("Bake", kiln::bake_options(settings));
    kiln::add_run_options(command, run);
    command.parse(argc, argv);

    kiln::OutputSet outputs(paths.output);
    const kiln::BakeScene scene = kiln::load_bake_scene(paths, settings);
    command.also_read(scene.further_files);
    command.warn(scene.warnings, scene.said_warnings);
    command.warn(kiln::direction_warnings(settings));
    const kiln::BakeResult result = kiln::run_bake(outputs, paths, scene, settings, run, command);
    const kiln::Json metrics = run.is_shard() ? kiln::describe_bake(scene, result)
                                              : kiln::save_bake(outputs, paths, scene, result, settings, command);
    command.finish(outputs, command.result(result.seconds, metrics));
    kiln::remove_checkpoints(paths);
  });
}
