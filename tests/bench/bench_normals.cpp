// SPDX-License-Identifier: GPL-3.0-or-later
// Compares normal maps with another baker's: peers/blender_normals.py runs all of it.
//
//   bench_normals export HIGH ATLAS FOLDER     both meshes as OBJ files, positions shared, for the other program
//   bench_normals bake HIGH ATLAS OUT.png      Kiln's map of the atlas: seconds and CPU seconds, the best of --repeat
//   bench_normals measure HIGH ATLAS MAP       the angular error of an object-space map, ours or theirs (PNG of 16
//   bits, EXR)

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <ctime>
#include <filesystem>
#include <string>

#include "base/extent.h"
#include "image/image_file.h"
#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "maps/detail_maps.h"
#include "maps/seams.h"
#include "mesh/draco_file.h"
#include "normals/map_error.h"
#include "normals/normals.h"
#include "obj_writer.h"

namespace {

using namespace kiln;
namespace fs = std::filesystem;

Image<float> load_map(const fs::path& file) {
  if (file.extension() == ".png") return dequantise_normals(read_png16(file));
  const Image<float> stored = read_float_image(file);
  Image<float> map(stored.width(), stored.height(), 3);
  for (int j = 0; j < map.height(); ++j)
    for (int i = 0; i < map.width(); ++i)
      for (int c = 0; c < 3; ++c) map.at(i, j, c) = 2 * stored.at(i, j, c) - 1;
  normalise(map, NormalSpace::object);
  return map;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Normal maps beside another baker's");
  std::string high_file, atlas_file, output, map_file;
  int size = 512, samples = 1, repeat = 5;
  CLI::App* export_mode = app.add_subcommand("export", "Both meshes as OBJ");
  CLI::App* bake_mode = app.add_subcommand("bake", "Kiln's map");
  CLI::App* measure_mode = app.add_subcommand("measure", "The error of a map");
  for (CLI::App* mode : {export_mode, bake_mode, measure_mode}) {
    mode->add_option("high", high_file)->required();
    mode->add_option("atlas", atlas_file)->required();
  }
  export_mode->add_option("folder", output)->required();
  bake_mode->add_option("output", output)->required();
  bake_mode->add_option("--size", size);
  bake_mode->add_option("--samples", samples);
  bake_mode->add_option("--repeat", repeat);
  bool fit = false;
  bake_mode->add_flag("--fit", fit);
  measure_mode->add_option("map", map_file)->required();
  app.require_subcommand(1);
  CLI11_PARSE(app, argc, argv);

  const TriangleMesh high = load_mesh(high_file);
  const TriangleMesh atlas = load_atlas(atlas_file);
  if (export_mode->parsed()) {
    write_peer_obj(fs::path(output) / "high.obj", high);
    write_peer_obj(fs::path(output) / "low.obj", atlas);
  } else if (bake_mode->parsed()) {
    NormalsSettings settings;
    settings.size = Extent(size);
    settings.samples = samples;
    settings.fit = fit;
    NormalsResult result;
    double seconds = 1e9, cpu = 1e9;
    for (int k = 0; k < repeat; ++k) {
      const std::clock_t before = std::clock();
      std::clock_t made = before;  // time when the maps are ready, before the metrics
      result = make_normals(high, atlas, settings, read_asset_hints(fs::path(atlas_file).parent_path()),
                            [&](double fraction) { made = fraction >= 1 ? std::clock() : made; });
      seconds = std::min(seconds, result.seconds);
      cpu = std::min(cpu, static_cast<double>(made - before) / CLOCKS_PER_SEC);
    }
    write_png(output, result.normal);
    std::printf("{\"seconds\": %.4f, \"cpu_seconds\": %.4f, \"cage_distance\": %.6g}\n", seconds, cpu,
                result.cage_distance);
  } else {
    const Image<float> map = load_map(map_file);
    const MatchPlan whole;
    const MapError error = measure_map_error({high, atlas, whole}, map, NormalSpace::object);
    const SeamMismatch seams = Seams(atlas, map.width(), map.height()).mismatch_degrees(map, NormalSpace::object);
    std::printf("{\"mean\": %.4f, \"p95\": %.4f, \"max\": %.4f, \"seam_mean\": %.4f, \"seam_max\": %.4f}\n",
                error.mean_degrees, error.percentile_95_degrees, error.largest_degrees, seams.mean, seams.largest);
  }
  return 0;
}
