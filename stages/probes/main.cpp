// SPDX-License-Identifier: GPL-3.0-or-later
#include "base/command_line.h"
#include "base/errors.h"
#include "base/json.h"
#include "base/outputs.h"
#include "base/stopwatch.h"
#include "probes/probe_files.h"
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
    if (!points_file.empty() && (command.given("grid") || command.given("box")))
      throw WrongUsage("--points and a grid are two ways to say where probes stand; give one of them");

    // Load.
    std::vector<Eigen::Vector3f> points;
    if (!points_file.empty()) points = read_points(points_file);
    const SceneMesh scene = load_probe_scene(high_files, settings, command);
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
