// SPDX-License-Identifier: GPL-3.0-or-later
// Compares ambient occlusion with another baker's: peers/blender_ao.py runs all of it.
//
//   bench_ao export HIGH ATLAS FOLDER     both meshes as OBJ files with their normals, for the other program
//   bench_ao compare REFERENCE MAP... [--against MAP]     the error of maps over the texels that the atlas covers,
//                                                         against the reference or, over its texels, another map
//
// REFERENCE and MAP are folders of kiln-bake with one band, whose transfer coefficient over 0.282095 is the share of
// the sky that a texel sees, weighted by the cosine; or a MAP is a picture of that share, an EXR file. Errors are root
// mean squares relative to that of the reference.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <numeric>
#include <stdexcept>
#include <string>
#include <vector>

#include "asset/prt_asset.h"
#include "image/image_file.h"
#include "import/import_mesh.h"
#include "maps/asset_hints.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "obj_writer.h"

namespace {

using namespace kiln;
namespace fs = std::filesystem;

constexpr float unoccluded = 0.28209479f;

/// Open share of the sky in one map, rows as in Image.
struct Occlusion {
  int width = 0, height = 0;
  std::vector<float> open;  ///< per texel; 1 if nothing is in the way
};

Occlusion of_asset(const PrtAsset& asset) {
  if (asset.bands != 1 || asset.channels != 1) throw std::runtime_error("a bake of one band and channel expected");
  std::vector<std::uint32_t> texels(static_cast<std::size_t>(asset.width) * static_cast<std::size_t>(asset.height));
  std::iota(texels.begin(), texels.end(), 0u);
  Occlusion occlusion{asset.width, asset.height, std::vector<float>(texels.size())};
  decode_transfer(asset, texels, occlusion.open);
  for (float& value : occlusion.open) value /= unoccluded;
  return occlusion;
}

Occlusion load_occlusion(const fs::path& file) {
  if (fs::is_directory(file)) return of_asset(load_prt_asset(file));
  const Image<float> picture = read_float_image(file);
  Occlusion occlusion{picture.width(), picture.height(), {}};
  for (int j = 0; j < picture.height(); ++j)
    for (int i = 0; i < picture.width(); ++i) occlusion.open.push_back(picture.at(i, j, 0));
  return occlusion;
}

/// Prints one JSON object: the relative error, that of the best 99 % of texels, the mean difference, and the number of
/// texels.
void compare(const Occlusion& reference, const UvRaster& covered, const fs::path& file) {
  const Occlusion map = load_occlusion(file);
  if (map.width != reference.width || map.height != reference.height)
    throw std::runtime_error(file.string() + " is of another size than the reference");
  std::vector<double> squares;
  double sum = 0, total = 0, reference_total = 0;
  for (std::size_t k = 0; k < reference.open.size(); ++k) {
    if (!covered.texels[k].covered()) continue;
    const double expected = reference.open[k], difference = map.open[k] - expected;
    squares.push_back(difference * difference);
    sum += difference;
    total += difference * difference;
    reference_total += expected * expected;
  }
  std::sort(squares.begin(), squares.end());
  const auto most = squares.begin() + static_cast<std::ptrdiff_t>(squares.size() * 99 / 100);
  std::printf("{\"error\": %.6f, \"error_of_99\": %.6f, \"mean_difference\": %.6f, \"texels\": %zu}\n",
              std::sqrt(total / reference_total),
              std::sqrt(std::accumulate(squares.begin(), most, 0.0) / reference_total),
              sum / static_cast<double>(squares.size()), squares.size());
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Ambient occlusion beside another baker's");
  std::string high_file, atlas_file, folder, reference_folder;
  std::string picture;
  std::vector<std::string> maps;
  CLI::App* export_mode = app.add_subcommand("export", "Both meshes as OBJ");
  export_mode->add_option("high", high_file)->required();
  export_mode->add_option("atlas", atlas_file)->required();
  export_mode->add_option("folder", folder)->required();
  CLI::App* compare_mode = app.add_subcommand("compare", "The errors of maps");
  compare_mode->add_option("reference", reference_folder)->required();
  compare_mode->add_option("maps", maps)->required();
  compare_mode->add_option("--against", picture, "A map to compare with in place of the reference, over its texels");
  app.require_subcommand(1);
  CLI11_PARSE(app, argc, argv);
  try {
    if (export_mode->parsed()) {
      TriangleMesh high = load_mesh(high_file);
      if (high.normals.empty()) compute_vertex_normals(high);
      write_peer_obj(fs::path(folder) / "high.obj", high, true);
      write_peer_obj(fs::path(folder) / "low.obj", load_atlas(atlas_file), true);
      return 0;
    }
    const PrtAsset reference = load_prt_asset(reference_folder);
    const UvRaster covered = rasterise_uvs(reference.mesh, reference.width, reference.height);
    const Occlusion expected = picture.empty() ? of_asset(reference) : load_occlusion(picture);
    for (const std::string& map : maps) compare(expected, covered, map);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "bench_ao: %s\n", error.what());
    return 1;
  }
  return 0;
}
