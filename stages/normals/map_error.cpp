// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/map_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "base/parallel.h"
#include "maps/footprint.h"
#include "mesh/tangent_space.h"
#include "normals/part_scene.h"

namespace kiln {

namespace {

/// Returns the `k`-th of `count` points: equal steps of area, and within triangles the R2 sequence [Roberts 2018].
SurfacePoint sample_at(const std::vector<double>& areas_up_to, int k, int count) {
  const double wanted = (k + 0.5) / count * areas_up_to.back();
  const auto triangle = std::upper_bound(areas_up_to.begin(), areas_up_to.end(), wanted) - areas_up_to.begin();
  double whole;
  double u = std::modf(0.5 + 0.7548776662466927 * k, &whole), v = std::modf(0.5 + 0.5698402909980532 * k, &whole);
  if (u + v > 1) u = 1 - u, v = 1 - v;
  SurfacePoint point;
  point.triangle = static_cast<std::uint32_t>(std::min<std::ptrdiff_t>(triangle, std::ssize(areas_up_to) - 1));
  point.u = static_cast<float>(u);
  point.v = static_cast<float>(v);
  return point;
}

/// Calls visit(k, point of the high mesh, point of the atlas mesh) for points spread over the high mesh, in parallel.
template <class Visit>
void for_each_sample(const MatchedMeshes& meshes, int samples, const Visit& visit) {
  const TriangleMesh& high = meshes.high;
  std::vector<double> areas_up_to(high.triangles.size());
  double area = 0;
  for (std::size_t t = 0; t < high.triangles.size(); ++t) {
    const auto at = [&](int k) -> Eigen::Vector3d {
      return high.positions[high.triangles[t][static_cast<std::size_t>(k)]].cast<double>();
    };
    areas_up_to[t] = area += (at(1) - at(0)).cross(at(2) - at(0)).norm();
  }
  if (!(area > 0)) return;

  const std::vector<PartScene> lows = scenes_of_parts(meshes.atlas, meshes.plan.low_part, meshes.plan.count());
  constexpr float anywhere = std::numeric_limits<float>::infinity();
  parallel_for(0, samples, 512, [&](int k) {
    const SurfacePoint at_high = sample_at(areas_up_to, k, samples);
    const Eigen::Vector3f point = position_at(high, at_high);
    const PartScene& low = lows[meshes.plan.part_of_high(at_high.triangle)];
    SurfacePoint at_low = low.closest_facing_point(point, normal_at(high, at_high), anywhere);
    if (!at_low.found()) at_low = low.closest_point(point, anywhere);
    visit(static_cast<std::size_t>(k), at_high, TexelSource{at_low.triangle, at_low.u, at_low.v});
  });
}

Eigen::Vector3f lookup(const Image<float>& map, const TriangleMesh& atlas, const TexelSource& source) {
  const Footprint footprint(interpolate(atlas, atlas.uvs, source), map.width(), map.height());
  Eigen::Vector3f value;
  for (int channel = 0; channel < 3; ++channel) value[channel] = static_cast<float>(footprint.lookup(map, channel));
  return value;
}

double percentile_95(std::vector<double>& values) {
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(0.95 * static_cast<double>(values.size()));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

}  // namespace

MapError measure_map_error(const MatchedMeshes& meshes, const Image<float>& map, NormalSpace space, int samples) {
  const TriangleMesh &high = meshes.high, &atlas = meshes.atlas;
  const std::vector<TangentFrame> frames =
      space == NormalSpace::tangent ? tangent_frames(atlas) : std::vector<TangentFrame>{};
  std::vector<double> degrees(static_cast<std::size_t>(samples), 0);
  for_each_sample(meshes, samples, [&](std::size_t k, const SurfacePoint& at_high, const TexelSource& source) {
    Eigen::Vector3f shown = lookup(map, atlas, source);
    if (space == NormalSpace::tangent)
      shown = to_object_space(shown, interpolate(atlas, atlas.normals, source), interpolate(atlas, frames, source));
    const Eigen::Vector3d a = shown.cast<double>(), b = normal_at(high, at_high).cast<double>();
    // The arc cosine is inexact for small angles.
    degrees[k] = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::acos(-1.0);
  });

  MapError error;
  for (const double angle : degrees) error.mean_degrees += angle;
  error.mean_degrees /= samples;
  error.percentile_95_degrees = percentile_95(degrees);
  error.largest_degrees = *std::max_element(degrees.begin(), degrees.end());
  return error;
}

AlbedoError measure_albedo_error(const MatchedMeshes& meshes, const SurfaceAlbedo& albedo, const Image<float>& map,
                                 int samples) {
  std::vector<Eigen::Vector3d> differences(static_cast<std::size_t>(samples), Eigen::Vector3d::Zero());
  for_each_sample(meshes, samples, [&](std::size_t k, const SurfacePoint& at_high, const TexelSource& source) {
    differences[k] =
        (lookup(map, meshes.atlas, source) - albedo.at(at_high.triangle, at_high.u, at_high.v)).cast<double>();
  });
  AlbedoError error;
  std::vector<double> largest;
  for (const Eigen::Vector3d& difference : differences) {
    error.rms += difference.squaredNorm();
    largest.push_back(difference.cwiseAbs().maxCoeff());
  }
  error.rms = std::sqrt(error.rms / (3.0 * samples));
  error.percentile_95 = percentile_95(largest);
  return error;
}

}  // namespace kiln
