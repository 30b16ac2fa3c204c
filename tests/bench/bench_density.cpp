// SPDX-License-Identifier: GPL-3.0-or-later
// Measures the error of transfer in small atlases whose charts have even or signal-aware scales: `bench_density HIGH
// low.drc...`. Prints Markdown. Both atlases hold the transfer of the high mesh's points that their texels stand for;
// bilinear lookups at points spread over the low mesh are compared with transfer computed at these points.

#include <CLI/CLI.hpp>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>

#include "atlas/atlas.h"
#include "base/progress.h"
#include "cost.h"
#include "image/gutter.h"
#include "import/import_mesh.h"
#include "mesh/draco_file.h"
#include "mesh/uv_raster.h"
#include "raycast/ray_scene.h"
#include "raycast/surface_transfer.h"

namespace kiln {
namespace {

struct Points {
  std::vector<Eigen::Vector3f> positions, normals;
  Receivers view() const { return {positions, normals}; }
};

/// Adds a point of the low mesh, and the point of the high mesh that it stands for.
void add_point(const TriangleMesh& high, const RayScene& scene, const Eigen::Vector3f& point,
               const Eigen::Vector3f& normal, Points& points) {
  const SurfacePoint found = scene.closest_facing_point(point, normal, std::numeric_limits<float>::infinity());
  const Triangle& t = high.triangles[found.triangle];
  const auto at = [&](const std::vector<Eigen::Vector3f>& values) -> Eigen::Vector3f {
    return (1 - found.u - found.v) * values[t[0]] + found.u * values[t[1]] + found.v * values[t[2]];
  };
  points.positions.push_back(at(high.positions));
  points.normals.push_back(at(high.normals).normalized());
}

struct Lookup {
  std::uint32_t triangle;
  float u, v;
};

/// Spreads points evenly over the surface, the same for all atlases of one mesh.
std::vector<Lookup> spread_points(const TriangleMesh& mesh, std::size_t count) {
  std::vector<double> sums;
  double sum = 0;
  for (const Triangle& t : mesh.triangles) {
    const Eigen::Vector3d a = mesh.positions[t[0]].cast<double>(), b = mesh.positions[t[1]].cast<double>(),
                          c = mesh.positions[t[2]].cast<double>();
    sums.push_back(sum += 0.5 * (b - a).cross(c - a).norm());
  }
  std::mt19937_64 random(1);
  const auto chance = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  std::vector<Lookup> points;
  for (std::size_t i = 0; i < count; ++i) {
    const double place = (static_cast<double>(i) + chance()) / static_cast<double>(count) * sum;
    const auto triangle = std::min(
        sums.size() - 1, static_cast<std::size_t>(std::lower_bound(sums.begin(), sums.end(), place) - sums.begin()));
    const double root = std::sqrt(chance()), share = chance();
    points.push_back({static_cast<std::uint32_t>(triangle), static_cast<float>(root * (1 - share)),
                      static_cast<float>(root * share)});
  }
  return points;
}

/// Looks up transfer bilinearly in an atlas with filled gutters.
TransferVectors looked_up(const TriangleMesh& atlas, int size, const UvRaster& raster, const TransferVectors& texels,
                          const std::vector<Lookup>& points) {
  std::vector<std::uint8_t> covered;
  for (const TexelSource& texel : raster.texels) covered.push_back(texel.covered() ? 1 : 0);
  TransferVectors result(points.size(), texels.coefficients);
  for (int k = 0; k < texels.coefficients; ++k) {
    Image<float> plane(size, size, 1);
    std::size_t next = 0;
    for (std::size_t i = 0; i < covered.size(); ++i)
      if (covered[i] != 0) plane.values()[i] = texels.plane(k)[next++];
    fill_gutters(plane, covered);
    for (std::size_t p = 0; p < points.size(); ++p) {
      const Eigen::Vector2f uv = interpolate(atlas, atlas.uvs, points[p]);
      const double x = static_cast<double>(uv.x()) * size - 0.5, y = static_cast<double>(uv.y()) * size - 0.5;
      const int i = std::clamp(static_cast<int>(std::floor(x)), 0, size - 2);
      const int j = std::clamp(static_cast<int>(std::floor(y)), 0, size - 2);
      const double u = x - i, v = y - j;
      result.plane(k)[p] = static_cast<float>((1 - v) * ((1 - u) * plane.at(i, j) + u * plane.at(i + 1, j)) +
                                              v * ((1 - u) * plane.at(i, j + 1) + u * plane.at(i + 1, j + 1)));
    }
  }
  return result;
}

int run(int argc, char** argv) {
  CLI::App app("Error of transfer in atlases of even and signal-aware density");
  std::filesystem::path high_file;
  std::vector<std::filesystem::path> low_files;
  std::vector<int> sizes = {128, 256};
  int gutter = 2, directions = 1024, seeds = 3;
  std::size_t count = 50000;
  app.add_option("high", high_file)->required();
  app.add_option("low", low_files)->required();
  app.add_option("--size", sizes);
  app.add_option("--gutter", gutter);
  app.add_option("--directions", directions);
  app.add_option("--points", count);
  app.add_option("--seeds", seeds, "Packings that figures are the mean of");
  CLI11_PARSE(app, argc, argv);

  const TriangleMesh high = load_mesh(high_file);
  const RayScene scene(high);
  const SurfaceTransferSettings transfer{.bands = 5, .directions = directions};
  std::printf(
      "| low mesh | atlas | density | texels per unit, least to most | covered | relative L2 | relighting error | s "
      "|\n");
  std::printf("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const std::filesystem::path& low_file : low_files) {
    const TriangleMesh low = load_draco(low_file);
    const std::vector<Lookup> points = spread_points(low, count);
    Points reference_points;
    for (const Lookup& point : points) {
      const TexelSource source{point.triangle, point.u, point.v};
      add_point(high, scene, interpolate(low, low.positions, source),
                interpolate(low, low.normals, source).normalized(), reference_points);
    }
    const TransferVectors reference = surface_transfer(high, reference_points.view(), transfer);
    for (const int size : sizes)
      for (const char* density : {"even", "transfer of low", "transfer of high"}) {
        double l2 = 0, relighting = 0, covered = 0, seconds = 0, least = 0, most = 0;
        for (int seed = 1; seed <= seeds; ++seed) {
          AtlasSettings settings;
          settings.size = size;
          settings.gutter = gutter;
          settings.seed = seed;
          settings.density = density[0] == 'e' ? AtlasDensity::even : AtlasDensity::transfer;
          const bool of_high = std::string(density).ends_with("high");
          AtlasResult result;
          const Cost cost = cost_of(
              [&] { result = make_atlas(low, settings, low_file.string(), no_progress, of_high ? &high : nullptr); });
          const AtlasMeasures measures = measure_atlas(result.mesh, size, size);
          const UvRaster raster = rasterise_uvs(result.mesh, size, size);
          Points texels;
          for (const TexelSource& texel : raster.texels)
            if (texel.covered())
              add_point(high, scene, interpolate(result.mesh, result.mesh.positions, texel),
                        interpolate(result.mesh, result.mesh.normals, texel).normalized(), texels);
          const TransferVectors found =
              looked_up(result.mesh, size, raster, surface_transfer(high, texels.view(), transfer), points);
          l2 += relative_l2(found, reference) / seeds;
          relighting += expected_relighting_error(found, reference) / seeds;
          covered += measures.utilisation / seeds;
          seconds += cost.cpu / seeds;
          least += measures.density_min / measures.texels_per_unit / seeds;
          most += measures.density_max / measures.texels_per_unit / seeds;
        }
        std::printf("| %s, %zu | %d | %s | %.2f to %.2f | %.3f | %.4f | %.4f | %.2f |\n",
                    low_file.parent_path().filename().c_str(), low.triangles.size(), size, density, least, most,
                    covered, l2, relighting, seconds);
        std::fflush(stdout);
      }
  }
  return 0;
}

}  // namespace
}  // namespace kiln

int main(int argc, char** argv) { return kiln::run(argc, argv); }
