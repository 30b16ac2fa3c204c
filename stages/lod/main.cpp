// SPDX-License-Identifier: GPL-3.0-or-later
#include <optional>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "import/import_mesh.h"
#include "lod/lod.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-lod", [&] {
    // Parse.
    CommandLine command("kiln-lod", "Makes coarser levels of an atlas mesh, which share its uvs and what is baked.");
    std::filesystem::path atlas_file, high_file, folder;
    LodSettings settings;
    command.input("ATLAS", atlas_file, "The low mesh with its atlas, a Draco file of kiln-atlas");
    command.input_option("high", high_file, "The high mesh, which the levels are measured against as well");
    command.output(folder, "The folder for lod_1.drc and so on, the finest level first, and lod.json");
    command.options("Levels of detail", lod_options(settings));
    command.parse(argc, argv);
    if (command.given("levels") && command.given("pixels"))
      throw WrongUsage("pixels: found --levels as well; expected one of them");

    // Load.
    const AssetHints hints = read_asset_hints(folder_of(atlas_file));
    const TriangleMesh atlas = load_atlas(atlas_file);
    std::optional<ImportedMesh> high;
    if (!high_file.empty()) {
      high = import_mesh(high_file, hints.import, atlas.frame);
      command.warn(high->warnings, hints.warnings);
    }
    const LodInput input = lod_input(atlas, high ? &high->mesh : nullptr, settings, hints, atlas_file.string());
    OutputSet outputs(folder);

    // Run, save, and measure what was saved.
    const LodResult result = make_levels(outputs, input, settings, command.progress("lod"));
    command.warn(result.warnings);
    command.finish(outputs, command.result(result.seconds, result.to_json(input)));
  });
}
