// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/errors.h"
#include "base/json.h"
#include "import/import_mesh.h"
#include "mesh/hard_edges.h"
#include "simplify/low_file.h"
#include "simplify/simplify.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-simplify", [&] {
    // Parse.
    CommandLine command("kiln-simplify", "Turns a high-poly mesh into one of few triangles that keeps its shape.");
    std::filesystem::path high_file, low_file;
    SimplifySettings settings;
    command.input("HIGH", high_file, "The mesh: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.output(low_file, "The simplified mesh, a Draco file: positions and normals, and colours with --colors");
    command.options("Simplification", simplify_options(settings));
    command.parse(argc, argv);
    check_options(settings, [&](const std::string& option) { return command.given(option); });

    // Load and run; each candidate is written, so that what is measured is what the file holds.
    const ImportedMesh imported = import_mesh(high_file, settings.import);
    const TriangleMesh& high = imported.mesh;
    const MeshRepairs& repairs = imported.repairs;
    command.warn(imported.warnings);
    if (settings.strict && !repairs.is_clean())
      throw BadInput(high_file.string(), "needs repair: " + repairs.text(), "a clean, oriented manifold of triangles",
                     "mend it where it comes from, or leave out --strict");
    if (settings.colors && high.colors.empty())
      throw BadInput(high_file.string(), "has no colours of vertices", "a file with colours of vertices",
                     "export them, or leave out --colors");
    OutputSet outputs(folder_of(low_file));
    LowFile low(outputs.add(low_file.filename().string()), high_file.string());
    if (settings.colors) low.keep_colors(high);
    const SimplifyResult result = simplify(
        high, settings, [&](const TriangleMesh& mesh) { return low.write(mesh); }, command.progress("simplify"));
    if (settings.strict && !result.shortfall.empty())
      throw BadInput(high_file.string(), result.shortfall, "a mesh that can have so few",
                     "give more --faces, or leave out --strict");

    // Save.
    Json metrics = result.to_json();
    metrics["position_bits"] = low.position_bits();
    metrics["input_components"] = repairs.components;
    metrics["input_border_loops"] = repairs.border_loops;
    metrics["repairs"] = repairs_to_json(repairs);
    metrics["origin"] = {high.frame.origin.x(), high.frame.origin.y(), high.frame.origin.z()};
    metrics["hard_edges"] = hard_edges_of_normals(high).size();
    std::vector<std::string> warnings;
    if (result.dropped.components > 0) warnings.push_back(result.dropped.text());
    if (!result.shortfall.empty()) warnings.push_back(result.shortfall);
    if (low.too_few_steps() > 0)
      warnings.push_back(
          "parts are so far apart that the smallest is " + std::to_string(static_cast<long long>(low.too_few_steps())) +
          " steps of 24 bits wide, the most that the file has; simplify it on its own to keep its shape");
    command.warn(warnings);
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
