#include <optional>

#include "base/command_line.h"
#include "base/errors.h"
#include "material/load_albedo.h"
#include "probes/probe_points.h"
#include "probes/probes.h"

int main(int argc, char** argv) {
  using namespace kiln;
  return run_program("kiln-probes", [&] {
    // Parse.
    CommandLine command(
        "kiln-probes",
        "What meshes do to the light at points around them: shadow and bounced light for things that move.");
    std::vector<std::filesystem::path> high_files;
    std::filesystem::path points_file, output;
    ProbesSettings settings;
    command.inputs("HIGH", high_files, "The meshes that stand in the light: OBJ, PLY, STL, OFF, glTF, GLB, FBX or DRC");
    command.input_option("points", points_file, "A text file of points, X Y Z a line, in place of a grid");
    command.output(output, "Folder for matrices.json and matrices.png");
    command.options("Probes", probes_options(settings));
    command.parse(argc, argv);
    if (!points_file.empty() && (command.app().count("--grid") > 0 || command.app().count("--box") > 0))
      throw WrongUsage("--points and a grid are two ways to say where probes stand; give one of them");

    // Load.
    std::vector<Eigen::Vector3f> points;
    if (!points_file.empty()) points = read_points(points_file);
    ProbeScene scene;
    std::optional<MeshFrame> frame;  // that of the first mesh
    for (const std::filesystem::path& file : high_files) {
      const ImportedMesh imported = import_mesh(file, settings.import, frame);
      command.warn(imported.warnings);
      frame = imported.mesh.frame;
      if (*frame != MeshFrame())
        throw BadInput(file.string(),
                       "lies many times its size from the origin, or is a million times larger or smaller "
                       "than one unit",
                       "a mesh whose probes can be told as floats", "move it, or give --scale");
      if (settings.bounces == "0") {
        scene.add(imported.mesh);
        continue;
      }
      const LoadedAlbedo loaded = load_albedo(imported, settings.material);
      if (loaded.albedo.source() == SurfaceAlbedo::Source::none)
        throw WrongUsage("bounces: found no albedo in " + file.string() +
                         "; expected materials, colours of vertices, --albedo or --albedo-texture");
      command.warn(loaded.warnings());
      command.also_read(loaded.files);
      scene.add(imported.mesh, loaded.albedo);
    }
    OutputSet outputs(output);

    // Run.
    const Stopwatch watch;
    const SurfaceLight light = light_surface(scene, settings, command.seed(), command.progress("bounces"));
    const ProbesResult result = probe_matrices(scene.mesh, light, place_probes(scene.mesh, points, settings), settings,
                                               command.seed(), command.progress("probes"));
    const double seconds = watch.seconds();

    // Save.
    save_probes(outputs, result.probes);
    command.finish(outputs, command.result(seconds, result.to_json()));
  });
}
