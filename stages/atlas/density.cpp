// SPDX-License-Identifier: GPL-3.0-or-later
#include "atlas/density.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "base/parallel.h"
#include "mesh/uv_raster.h"
#include "raycast/ray_scene.h"
#include "raycast/surface_transfer.h"

namespace kiln {

namespace {

/// Samples of one chart: a grid over its uvs.
struct ChartGrid {
  int width = 0;
  int height = 0;
  std::vector<std::uint32_t> samples;  ///< index of the sample at [j * width + i], or no_index

  std::uint32_t at(int i, int j) const {
    return i < 0 || j < 0 || i >= width || j >= height ? no_index : samples[static_cast<std::size_t>(j) * width + i];
  }
};

struct Samples {
  std::vector<Eigen::Vector3f> positions, normals;
  std::vector<ChartGrid> grids;  ///< per chart
};

/// Places samples at the crossings of a grid of that spacing, chart after chart.
Samples sample_charts(const Surface& surface, const std::vector<Chart>& charts, double spacing) {
  constexpr int widest = 4096;  // texels a side; charts of an extreme shape get a coarser grid
  Samples samples;
  for (const Chart& chart : charts) {
    Eigen::Vector2d lowest = chart.uvs[0], highest = lowest;
    for (const Eigen::Vector2d& uv : chart.uvs) {
      lowest = lowest.cwiseMin(uv);
      highest = highest.cwiseMax(uv);
    }
    const double step = std::max(spacing, (highest - lowest).maxCoeff() / widest);
    ChartGrid grid;
    grid.width = static_cast<int>((highest.x() - lowest.x()) / step) + 1;
    grid.height = static_cast<int>((highest.y() - lowest.y()) / step) + 1;
    TriangleMesh flat;  // the chart, with the grid's cells as texels
    flat.triangles = chart.triangles;
    const Eigen::Vector2d extent(grid.width * step, grid.height * step);
    for (std::size_t v = 0; v < chart.vertices.size(); ++v) {
      flat.positions.push_back(surface.mesh->positions[chart.vertices[v]]);
      flat.normals.push_back(surface.mesh->normals[chart.vertices[v]]);
      flat.uvs.emplace_back((chart.uvs[v] - lowest).cwiseQuotient(extent).cast<float>());
    }
    const UvRaster raster = rasterise_uvs(flat, grid.width, grid.height);
    grid.samples.assign(raster.texels.size(), no_index);
    for (std::size_t k = 0; k < raster.texels.size(); ++k) {
      if (!raster.texels[k].covered()) continue;
      grid.samples[k] = static_cast<std::uint32_t>(samples.positions.size());
      samples.positions.push_back(interpolate(flat, flat.positions, raster.texels[k]));
      const Eigen::Vector3f normal = interpolate(flat, flat.normals, raster.texels[k]);
      samples.normals.push_back(normal.squaredNorm() > 0 ? normal.normalized() : Eigen::Vector3f::UnitY());
    }
    samples.grids.push_back(std::move(grid));
  }
  return samples;
}

/// Moves samples to the nearest point of `high` that faces the same way.
void move_to(const TriangleMesh& high, Samples& samples) {
  const RayScene scene(high);
  parallel_for(std::size_t{0}, samples.positions.size(), [&](std::size_t k) {
    const SurfacePoint found =
        scene.closest_facing_point(samples.positions[k], samples.normals[k], std::numeric_limits<float>::infinity());
    if (!found.found()) return;
    samples.positions[k] = position_at(high, found);
    const Eigen::Vector3f normal = interpolate(high, high.normals, found);
    if (normal.squaredNorm() > 0) samples.normals[k] = normal.normalized();
  });
}

struct ErrorSum {
  double squares = 0;
  double count = 0;
};

/// Sums the error of interpolating each sample of a chart from its neighbours `reach` to either side.
ErrorSum interpolation_error(const ChartGrid& grid, const std::vector<float>& by_sample, int coefficients, int reach) {
  ErrorSum sum;
  for (int j = 0; j < grid.height; ++j)
    for (int i = 0; i < grid.width; ++i) {
      const std::uint32_t centre = grid.at(i, j);
      if (centre == no_index) continue;
      for (const bool upwards : {false, true}) {
        const int x = upwards ? 0 : reach, y = upwards ? reach : 0;
        const std::uint32_t before = grid.at(i - x, j - y), after = grid.at(i + x, j + y);
        if (before == no_index || after == no_index) continue;
        for (int k = 0; k < coefficients; ++k) {
          const auto value = [&](std::uint32_t sample) {
            return static_cast<double>(by_sample[static_cast<std::size_t>(sample) * coefficients + k]);
          };
          const double error = 0.5 * (value(before) + value(after)) - value(centre);
          sum.squares += error * error;
        }
        ++sum.count;
      }
    }
  return sum;
}

/// Clamps scales to the bounds, and scales all so that the sum of area times squared scale equals the sum of areas.
void normalise(std::vector<double>& scales, const std::vector<double>& areas, const DensitySettings& settings) {
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  for (int round = 0; round < 20; ++round) {
    double texels = 0;
    for (std::size_t c = 0; c < scales.size(); ++c) texels += areas[c] * scales[c] * scales[c];
    const double factor = std::sqrt(area / texels);
    for (double& scale : scales) scale = std::clamp(scale * factor, settings.least_scale, settings.most_scale);
    if (std::abs(factor - 1) < 1e-9) break;
  }
}

}  // namespace

ChartDensities densities_by_transfer(const Surface& surface, const std::vector<Chart>& charts, const TriangleMesh* high,
                                     const DensitySettings& settings) {
  // Step 1: compute transfer over a grid on each chart.
  const double grid_spacing = std::sqrt(surface.area / settings.samples);
  Samples samples = sample_charts(surface, charts, grid_spacing);
  if (high != nullptr) move_to(*high, samples);
  const TransferVectors transfer =
      surface_transfer(high != nullptr ? *high : *surface.mesh, {samples.positions, samples.normals},
                       {.bands = settings.bands, .directions = settings.directions});
  std::vector<float> by_sample(transfer.values.size());
  for (int k = 0; k < transfer.coefficients; ++k)
    for (std::size_t r = 0; r < transfer.receivers; ++r)
      by_sample[r * transfer.coefficients + k] = transfer.plane(k)[r];

  // Step 2: measure the error of interpolation, and how it grows with the spacing.
  ChartDensities result;
  result.spacing = 2 * grid_spacing;
  std::vector<double> areas(charts.size());
  std::vector<ErrorSum> sums(charts.size());
  ErrorSum total, total_wide;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    for (const std::uint32_t face : charts[c].faces) areas[c] += surface.rest[face].area;
    sums[c] = interpolation_error(samples.grids[c], by_sample, transfer.coefficients, 1);
    const ErrorSum wide = interpolation_error(samples.grids[c], by_sample, transfer.coefficients, 2);
    total.squares += sums[c].squares, total.count += sums[c].count;
    total_wide.squares += wide.squares, total_wide.count += wide.count;
  }
  result.scales.assign(charts.size(), 1);
  result.errors.assign(charts.size(), 0);
  if (!(total.squares > 0) || !(total_wide.squares > 0))
    return result;  // transfer does not vary, or there were no samples to compare
  const double mean = total.squares / total.count;
  result.order = std::clamp(std::log2(total_wide.squares / total_wide.count / mean), 1.0, 4.0);

  // Step 3: compute scales. Those of charts with few samples lean towards the mean.
  constexpr double lean = 8;
  for (std::size_t c = 0; c < charts.size(); ++c) {
    result.errors[c] = (sums[c].squares + lean * mean) / (sums[c].count + lean);
    result.scales[c] = std::pow(result.errors[c] / mean, 1 / (result.order + 2));
  }
  normalise(result.scales, areas, settings);
  return result;
}

void scale_charts(std::vector<Chart>& charts, const std::vector<double>& scales) {
  for (std::size_t c = 0; c < charts.size(); ++c)
    for (Eigen::Vector2d& uv : charts[c].uvs) uv *= scales[c];
}

}  // namespace kiln
