#include "base/command_line.h"
#include "base/errors.h"
#include "mesh/mesh_file.h"
#include "simplify/low_file.h"
#include "simplify/simplify.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-simplify", [&] {
    // Parse.
    CommandLine command("kiln-simplify", "Turns a high-poly mesh into one of few triangles that keeps its shape.");
    std::filesystem::path high_file, low_file;
    SimplifySettings settings;
    command.input("HIGH", high_file, "The mesh: OBJ, PLY, STL, OFF or DRC");
    command.output(low_file, "The simplified mesh, a Draco file: positions and normals, and colours with --colors");
    command.options("Simplification", simplify_options(settings));
    command.parse(argc, argv);
    if (settings.max_error > 0 && command.app().count("--faces") > 0)
      throw WrongUsage("--faces and --max-error are two ways to say where to stop; give one of them");

    // Load and run; each candidate is written, so that what is measured is what the file holds.
    MeshRepairs repairs;
    const TriangleMesh high = load_mesh(high_file, &repairs, {.fill_hole_edges = settings.fill_holes});
    if (settings.strict && !repairs.none())
      throw BadInput(high_file.string(), "needs repair: " + repairs.text(), "a clean, oriented manifold of triangles",
                     "mend it where it comes from, or leave out --strict");
    if (settings.colors && high.colors.empty())
      throw BadInput(high_file.string(), "has no colours of vertices", "an OBJ, PLY, OFF or DRC file with colours",
                     "export them, or leave out --colors");
    OutputSet outputs(folder_of(low_file));
    LowFile low(outputs.add(low_file.filename().string()));
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
    if (result.dropped.components > 0) command.say(result.dropped.text());
    if (!result.shortfall.empty()) command.say(result.shortfall);
    if (low.too_few_steps() > 0)
      command.say("parts are so far apart that the smallest is " +
                  std::to_string(static_cast<long long>(low.too_few_steps())) +
                  " steps of 24 bits wide, the most that the file has; simplify it on its own to keep its shape");
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
