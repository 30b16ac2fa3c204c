// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/errors.h"
#include "base/files.h"
#include "base/json.h"
#include "base/outputs.h"
#include "import/import_mesh.h"
#include "simplify/low_file.h"
#include "simplify/make_low.h"
#include "simplify/own_low.h"
#include "simplify/simplify_report.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-simplify", [&] {
    // Parse.
    CommandLine command(
        "kiln-simplify",
        "Turns a high-poly mesh into one of few triangles that keeps its shape, or takes such a mesh of yours.");
    std::filesystem::path high_file, low_file;
    SimplifySettings settings;
    command.input("HIGH", high_file, "The mesh: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.output(low_file,
                   "The low mesh, a Draco file: positions and normals, colours with --colors, and uvs that --low has");
    command.options("Simplification", simplify_options(settings));
    command.parse(argc, argv);
    check_options(settings, [&](const std::string& option) { return command.given(option); });

    // Load and run; each candidate is written, so that what is measured is what the file holds.
    const ImportedMesh imported = import_mesh(high_file, settings.import);
    const TriangleMesh& high = imported.mesh;
    command.warn(imported.warnings);
    check_high(imported, settings, high_file.string());
    OutputSet outputs(folder_of(low_file));
    LowFile low(outputs.add(low_file.filename().string()), settings.low.empty() ? high_file.string() : settings.low);
    if (settings.colors) low.keep_colors(high);
    const std::optional<OwnLow> own_low = load_own_low(settings, high);
    if (own_low) {
      check_low(*own_low, settings);
      command.warn(own_low->warnings);
      command.also_read(own_low->files);
    }
    std::vector<std::string> warnings;
    const KeepingResult made = make_low(imported, own_low ? &*own_low : nullptr, settings, low, warnings,
                                        command.progress(own_low ? "measure" : "simplify"));
    command.warn(warnings);
    const SimplifyResult& result = made.simplified;
    if (settings.strict && !result.shortfall.empty())
      throw BadInput(high_file.string(), result.shortfall, "a mesh that can have so few",
                     "give more --faces, or leave out --strict");

    // Save.
    command.warn(warnings_of(result, low));
    command.finish(outputs,
                   command.result(result.seconds, metrics_of(made, imported, low, own_low ? &*own_low : nullptr)));
  });
}
