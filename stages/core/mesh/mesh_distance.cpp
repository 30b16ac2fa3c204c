// SPDX-License-Identifier: MIT
#include "mesh/mesh_distance.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "base/parallel.h"
#include "mesh/nearest_surface.h"

namespace kiln {

namespace {

/// Surface that samples are taken from.
struct SampledSurface {
  struct Face {
    Eigen::Vector3d a, ab, ac;
  };
  std::vector<Eigen::Vector3d> vertices;  ///< only vertices that a triangle uses
  std::vector<Face> faces;
  std::vector<double> area_up_to;  ///< summed area of the faces before and including this one
};

SampledSurface to_sampled(const TriangleMesh& mesh) {
  SampledSurface surface;
  std::vector<bool> used(mesh.positions.size(), false);
  double area = 0;
  for (const Triangle& t : mesh.triangles) {
    for (std::uint32_t vertex : t) used[vertex] = true;
    const Eigen::Vector3d a = mesh.positions[t[0]].cast<double>();
    const SampledSurface::Face face{a, mesh.positions[t[1]].cast<double>() - a,
                                    mesh.positions[t[2]].cast<double>() - a};
    area += 0.5 * face.ab.cross(face.ac).norm();
    surface.faces.push_back(face);
    surface.area_up_to.push_back(area);
  }
  for (std::uint32_t i = 0; i < used.size(); ++i)
    if (used[i]) surface.vertices.emplace_back(mesh.positions[i].cast<double>());
  return surface;
}

/// Returns the i-th number in [0, 1) of a stream: SplitMix64 [Steele 2014], which can be entered anywhere.
double random_number(std::uint64_t seed, std::uint64_t i) {
  std::uint64_t z = seed * 0xd1342543de82ef95ull + (i + 1) * 0x9e3779b97f4a7c15ull;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ull;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebull;
  z ^= z >> 31;
  return static_cast<double>(z >> 11) * 0x1p-53;
}

/// Returns sample i of n, one from each n-th part of the area.
Eigen::Vector3d sample(const SampledSurface& surface, std::uint64_t seed, std::uint64_t i, std::uint64_t n) {
  const double share = (static_cast<double>(i) + random_number(seed, 3 * i)) / static_cast<double>(n);
  const double at = share * surface.area_up_to.back();
  const auto found = std::upper_bound(surface.area_up_to.begin(), surface.area_up_to.end() - 1, at);
  const SampledSurface::Face& face = surface.faces[found - surface.area_up_to.begin()];
  double u = random_number(seed, 3 * i + 1);
  double v = random_number(seed, 3 * i + 2);
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return face.a + u * face.ab + v * face.ac;
}

struct OneWay {
  double hausdorff = 0;
  double rms = 0;
};

OneWay distance_to(const SampledSurface& from, const NearestSurface& to, const MeshDistanceSettings& settings) {
  const auto samples = static_cast<std::uint64_t>(settings.samples);
  const std::size_t points = samples + from.vertices.size();
  // Chunks of a fixed size, summed in order, make the result independent of the threads.
  constexpr std::size_t chunk_points = 512;
  struct Partial {
    double largest_squared = 0;
    double sum_squared = 0;
  };
  std::vector<Partial> partials((points + chunk_points - 1) / chunk_points);
  parallel_for(std::size_t{0}, partials.size(), [&](std::size_t chunk) {
    Partial& partial = partials[chunk];
    const std::size_t end = std::min(points, (chunk + 1) * chunk_points);
    std::uint32_t hint = 0;
    for (std::size_t i = chunk * chunk_points; i < end; ++i) {
      const bool is_sample = i < samples;
      const Eigen::Vector3d point = is_sample ? sample(from, settings.seed, i, samples) : from.vertices[i - samples];
      // The nearest triangle of the sample before is close to this sample too, and bounds the search.
      const NearestSurface::Hit hit = to.nearest(point, hint);
      hint = hit.hint;
      const double squared = hit.squared_distance;
      partial.largest_squared = std::max(partial.largest_squared, squared);
      if (is_sample) partial.sum_squared += squared;
    }
  });
  Partial total;
  for (const Partial& partial : partials) {
    total.largest_squared = std::max(total.largest_squared, partial.largest_squared);
    total.sum_squared += partial.sum_squared;
  }
  return {std::sqrt(total.largest_squared),
          samples > 0 ? std::sqrt(total.sum_squared / static_cast<double>(samples)) : 0};
}

}  // namespace

MeshDistance mesh_distance(const TriangleMesh& first, const TriangleMesh& second,
                           const MeshDistanceSettings& settings) {
  const NearestSurface first_surface(first), second_surface(second);  // both throw where there is no area
  const double diagonal = bounding_box(first).diagonal();
  const OneWay from_first = distance_to(to_sampled(first), second_surface, settings);
  const OneWay from_second = distance_to(to_sampled(second), first_surface, settings);
  MeshDistance distance;
  distance.hausdorff_from_first = from_first.hausdorff / diagonal;
  distance.hausdorff_from_second = from_second.hausdorff / diagonal;
  distance.rms_from_first = from_first.rms / diagonal;
  distance.rms_from_second = from_second.rms / diagonal;
  distance.hausdorff = std::max(distance.hausdorff_from_first, distance.hausdorff_from_second);
  distance.rms = std::max(distance.rms_from_first, distance.rms_from_second);
  return distance;
}

}  // namespace kiln
