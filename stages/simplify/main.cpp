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
    command.output(low_file, "The simplified mesh, a Draco file: positions and normals");
    command.options("Simplification", simplify_options(settings));
    command.parse(argc, argv);
    if (settings.max_error > 0 && command.app().count("--faces") > 0)
      throw WrongUsage("--faces and --max-error are two ways to say where to stop; give one of them");

    // Load and run; each candidate is written, so that what is measured is what the file holds.
    LoadRepairs load_repairs;
    const TriangleMesh high = load_mesh(high_file, &load_repairs);
    OutputSet outputs(folder_of(low_file));
    LowFile low(outputs.add(low_file.filename().string()));
    const SimplifyResult result = simplify(
        high, settings, [&](const TriangleMesh& mesh) { return low.write(mesh); }, command.progress("simplify"));

    // Save.
    Json metrics = result.to_json();
    metrics["position_bits"] = low.position_bits();
    metrics["repairs"] = repairs_to_json(load_repairs, result.repairs);
    if (settings.max_error == 0 && result.mesh.triangles.size() > static_cast<std::size_t>(settings.faces))
      command.say("stopped at " + std::to_string(result.mesh.triangles.size()) +
                  " triangles: no further collapse keeps topology and shape");
    command.finish(outputs, command.result(result.seconds, metrics));
  });
}
