// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "export/export_asset.h"
#include "export/sky_pictures.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-export", [&] {
    // Step 1: parse.
    CommandLine command(
        "kiln-export",
        "Writes a baked asset as one glTF file: a material that any viewer shows, and all that relights "
        "it, under the extension KILN_prt.");
    std::filesystem::path folder, file;
    bool meshopt = false, uncompressed = false;
    ExportSettings settings;
    command.input("PRT", folder, "Output folder of kiln-bake or kiln-compress; nothing else is read");
    command.output(file, "The file, whose name ends in .glb");
    command.flag("meshopt", meshopt, "Mesh", "Pack the mesh by EXT_meshopt_compression, lossless, instead of Draco");
    command.flag("uncompressed", uncompressed, "Mesh", "Do not pack the mesh");
    command.flag(
        "sh1", settings.sh1, "Pictures",
        "Write transfer of bands 0 and 1 as four pictures beside the file, too, NAME_sh1_w.png, _x, _y and _z, "
        "for materials of engines (docs/engines.md)");
    command.parse(argc, argv);
    if (meshopt && uncompressed)
      throw WrongUsage(
          "uncompressed: found --meshopt as well; expected one form of the mesh, Draco where none is named");
    if (file.extension() != ".glb")
      throw WrongUsage("output: found '" + file.string() + "'; expected a name that ends in .glb");
    if (meshopt) settings.form = GlbMeshForm::meshopt;
    if (uncompressed) settings.form = GlbMeshForm::plain;

    // Step 2: make the file in memory; step 3: write it, last of all.
    const Stopwatch watch;
    const ExportedAsset exported = export_asset(folder, file, settings);
    const double seconds = watch.seconds();
    OutputSet outputs(folder_of(file));
    if (exported.sky_pictures)
      for (std::size_t k = 0; k < exported.sky_pictures->size(); ++k)
        outputs.add_text(sky_picture_names(file.stem().string())[k], (*exported.sky_pictures)[k]);
    outputs.add_text(file.filename().string(), exported.glb);
    command.warn(exported.warnings);
    command.finish_without_record(outputs, command.result(seconds, exported.metrics));
  });
}
