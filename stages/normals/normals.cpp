#include "normals/normals.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include "base/command_line.h"
#include "base/errors.h"
#include "image/gutter.h"
#include "mesh/uv_raster.h"
#include "normals/surface_match.h"
#include "raycast/ray_scene.h"

namespace kiln {

namespace {

constexpr int default_size = 512;

/// Rays along a slanting normal are longer than the distance between the surfaces.
constexpr double cage_per_hausdorff_distance = 2;

/// A cage is at least this fraction of the diagonal: a mesh that was not simplified still is quantised.
constexpr double smallest_cage = 1e-4;

/// Fraction of the diagonal below which two surfaces are the same one: positions are quantised to 16 bits.
constexpr double surface_tolerance = 1e-5;

using Pixel = Eigen::Map<Eigen::Vector3f>;
using ConstPixel = Eigen::Map<const Eigen::Vector3f>;

double degrees_between(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  // The arc cosine has no digits left for small angles.
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / 3.14159265358979323846;
}

/// The largest distance found between points of both meshes' surfaces: texels of the low one, vertices of the high one.
double measure_distance(const TriangleMesh& high, const RayScene& high_scene, const TriangleMesh& atlas,
                        const UvRaster& raster) {
  const auto largest = [](std::size_t count, const auto& distance_of) {
    std::vector<float> distances(count, 0);
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count, 1024),
                      [&](const tbb::blocked_range<std::size_t>& part) {
                        for (std::size_t k = part.begin(); k < part.end(); ++k) distances[k] = distance_of(k);
                      });
    return *std::max_element(distances.begin(), distances.end());
  };
  constexpr float anywhere = std::numeric_limits<float>::infinity();
  const float from_low = largest(raster.texels.size(), [&](std::size_t k) {
    const TexelSource& source = raster.texels[k];
    return source.covered() ? high_scene.closest_point(interpolate(atlas, atlas.positions, source), anywhere).distance
                            : 0;
  });
  const RayScene low_scene(atlas);
  const float from_high = largest(high.positions.size(), [&](std::size_t k) {
    return low_scene.closest_point(high.positions[k], anywhere).distance;
  });
  return std::max(from_low, from_high);
}

/// What one texel row adds to the metrics; rows are added up in order, so that sums do not depend on threads.
struct RowSums {
  std::array<std::int64_t, 3> found{};  ///< by MatchWay
  std::int64_t disagreeing = 0;
  double distance = 0, largest_distance = 0;
};

/// What is written, decoded, against both meshes.
void measure_normals(const Image<float>& exact, const TriangleMesh& atlas, const UvRaster& raster,
                     NormalsResult& result) {
  const Image<float> decoded = decode_normals(result.normal, result.space, atlas, raster);
  double sum = 0;
  for (int j = 0; j < raster.height; ++j)
    for (int i = 0; i < raster.width; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const Eigen::Vector3d normal = ConstPixel(decoded.pixel(i, j).data()).cast<double>();
      const Eigen::Vector3d low_normal = interpolate(atlas, atlas.normals, source).cast<double>();
      const double deviation = degrees_between(normal, low_normal);
      sum += deviation;
      result.normal_deviation_degrees_largest = std::max(result.normal_deviation_degrees_largest, deviation);
      const Eigen::Vector3d wanted = ConstPixel(exact.pixel(i, j).data()).cast<double>();
      result.quantisation_degrees_largest =
          std::max(result.quantisation_degrees_largest, degrees_between(normal, wanted));
    }
  result.normal_deviation_degrees_mean = sum / static_cast<double>(raster.covered_texels);
}

}  // namespace

NormalsResult make_normals(const TriangleMesh& high, const TriangleMesh& atlas, const NormalsSettings& settings,
                           const AssetHints& hints, const ProgressFunction& progress) {
  const Stopwatch stopwatch;
  if (high.triangles.empty() || high.normals.size() != high.positions.size())
    throw std::invalid_argument("make_normals: a high mesh with normals is needed");
  if (atlas.normals.size() != atlas.positions.size() || atlas.uvs.size() != atlas.positions.size())
    throw std::invalid_argument("make_normals: an atlas mesh with normals and uvs is needed");

  // Texels.
  const int size = settings.size > 0 ? settings.size : hints.size > 0 ? hints.size : default_size;
  const UvRaster raster = rasterise_uvs(atlas, size, size);
  if (raster.covered_texels == 0)
    throw WrongUsage("the atlas covers no texel at --size " + std::to_string(size) + "; give a larger one");

  // How far to look.
  NormalsResult result;
  const RayScene scene(high);
  const double diagonal = bounding_box(high).diagonal();
  double distance = settings.cage * diagonal;
  result.cage_source = "option";
  if (settings.cage == 0) {
    result.cage_source = hints.hausdorff_distance > 0 ? "simplify.json" : "measured";
    distance = cage_per_hausdorff_distance *
               (hints.hausdorff_distance > 0 ? hints.hausdorff_distance : measure_distance(high, scene, atlas, raster));
    distance = std::max(distance, smallest_cage * diagonal);
  }
  const MatchLimits limits{static_cast<float>(distance), static_cast<float>(surface_tolerance * diagonal)};

  // A high point for each texel, in bands of rows so that progress can be told.
  Image<float> normal_object(size, size, 3);
  result.position = Image<float>(size, size, 3);
  std::vector<RowSums> rows(static_cast<std::size_t>(size));
  const auto match_row = [&](int j) {
    RowSums& sums = rows[static_cast<std::size_t>(j)];
    for (int i = 0; i < size; ++i) {
      const TexelSource& source = raster.at(i, j);
      if (!source.covered()) continue;
      const Eigen::Vector3f low_point = interpolate(atlas, atlas.positions, source);
      const Eigen::Vector3f low_normal = interpolate(atlas, atlas.normals, source).normalized();
      const SurfaceMatch match = match_surface(high, scene, low_point, low_normal, limits);
      const Eigen::Vector3f high_point = position_at(high, match.point);
      Pixel(result.position.pixel(i, j).data()) = high_point;
      Pixel(normal_object.pixel(i, j).data()) = normal_at(high, match.point);
      ++sums.found[static_cast<std::size_t>(match.way)];
      sums.disagreeing += match.agrees ? 0 : 1;
      const double apart = (high_point - low_point).cast<double>().norm() / diagonal;
      sums.distance += apart;
      sums.largest_distance = std::max(sums.largest_distance, apart);
    }
  };
  constexpr int band_rows = 32;
  for (int begin = 0; begin < size; begin += band_rows) {
    const int end = std::min(begin + band_rows, size);
    tbb::parallel_for(begin, end, match_row);
    progress(static_cast<double>(end) / size);
  }

  // Maps.
  const std::vector<std::uint8_t> covered = coverage_of(raster);
  fill_gutters(result.position, covered);
  result.space = settings.space;
  result.normal = encode_normals(normal_object, settings.space, atlas, raster);
  result.coverage = Image<std::uint8_t>(size, size, 1);
  std::transform(covered.begin(), covered.end(), result.coverage.values().begin(),
                 [](std::uint8_t c) { return static_cast<std::uint8_t>(c != 0 ? 255 : 0); });

  // Metrics.
  RowSums total;
  for (const RowSums& row : rows) {
    for (std::size_t way = 0; way < total.found.size(); ++way) total.found[way] += row.found[way];
    total.disagreeing += row.disagreeing;
    total.distance += row.distance;
    total.largest_distance = std::max(total.largest_distance, row.largest_distance);
  }
  result.covered_texels = raster.covered_texels;
  const double texels = static_cast<double>(raster.covered_texels);
  result.found_by_ray_outwards = static_cast<double>(total.found[static_cast<int>(MatchWay::ray_outwards)]) / texels;
  result.found_by_ray_inwards = static_cast<double>(total.found[static_cast<int>(MatchWay::ray_inwards)]) / texels;
  result.found_by_nearest_point = static_cast<double>(total.found[static_cast<int>(MatchWay::nearest_point)]) / texels;
  result.disagreeing = static_cast<double>(total.disagreeing) / texels;
  result.cage_distance = distance;
  result.mean_distance = total.distance / texels;
  result.largest_distance = total.largest_distance;
  measure_normals(normal_object, atlas, raster, result);
  result.seconds = stopwatch.seconds();
  return result;
}

Json NormalsResult::to_json() const {
  return {{"space", space == NormalSpace::object ? "object" : "tangent"},
          {"size", normal.width()},
          {"covered_texels", covered_texels},
          {"found_by_ray_outwards", found_by_ray_outwards},
          {"found_by_ray_inwards", found_by_ray_inwards},
          {"found_by_nearest_point", found_by_nearest_point},
          {"disagreeing", disagreeing},
          {"cage_distance", cage_distance},
          {"cage_source", cage_source},
          {"mean_distance", mean_distance},
          {"largest_distance", largest_distance},
          {"normal_deviation_degrees_mean", normal_deviation_degrees_mean},
          {"normal_deviation_degrees_largest", normal_deviation_degrees_largest},
          {"quantisation_degrees_largest", quantisation_degrees_largest}};
}

}  // namespace kiln
