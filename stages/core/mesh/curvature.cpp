// SPDX-License-Identifier: MIT
#include "mesh/curvature.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr int most_rounds = 256;  // of averaging

/// Integral of the mean curvature about each vertex, and the area that it is over.
struct Measures {
  std::vector<double> curvature, area;
};

/// Returns the vertices' normals: the directions of the sums of their faces' areas.
std::vector<Eigen::Vector3d> vertex_normals(const TriangleMesh& mesh, const std::vector<Triangle>& triangles) {
  std::vector<Eigen::Vector3d> normals(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const Triangle& triangle : triangles)
    for (const std::uint32_t v : triangle) normals[v] += area_normal(mesh, triangle);
  for (Eigen::Vector3d& normal : normals) normal.normalize();
  return normals;
}

Measures measure(const TriangleMesh& mesh, const std::vector<Triangle>& triangles) {
  Measures of{std::vector<double>(mesh.positions.size()), std::vector<double>(mesh.positions.size())};
  const std::vector<Eigen::Vector3d> normals = vertex_normals(mesh, triangles);
  for (const Triangle& triangle : triangles) {
    const double twice_area = area_normal(mesh, triangle).norm();
    if (!(twice_area > 0)) continue;
    std::array<Eigen::Vector3d, 3> at;
    for (std::size_t k = 0; k < 3; ++k) at[k] = mesh.positions[triangle[k]].cast<double>();
    for (std::size_t k = 0; k < 3; ++k) {
      // The side that lies opposite of corner k, weighed by the corner's cotangent.
      const std::size_t a = (k + 1) % 3, b = (k + 2) % 3;
      const double cotangent = (at[a] - at[k]).dot(at[b] - at[k]) / twice_area;
      const Eigen::Vector3d side = at[b] - at[a];
      for (const auto& [from, along] : {std::pair{a, Eigen::Vector3d(-side)}, {b, side}}) {
        of.curvature[triangle[from]] += cotangent * along.dot(normals[triangle[from]]) / 4;
        of.area[triangle[from]] += cotangent * side.squaredNorm() / 8;
      }
    }
  }
  return of;
}

/// Replaces each value by a mean of its own and those of its neighbours.
void average(std::vector<double>& values, const std::vector<Triangle>& triangles) {
  std::vector<double> sums(values.size()), counts(values.size(), 2);  // a neighbour is met in two triangles
  for (std::size_t v = 0; v < values.size(); ++v) sums[v] = 2 * values[v];
  for (const Triangle& t : triangles) {
    const double sum = values[t[0]] + values[t[1]] + values[t[2]];
    for (const std::uint32_t v : t) {
      sums[v] += sum - values[v];
      counts[v] += 2;
    }
  }
  for (std::size_t v = 0; v < values.size(); ++v) values[v] = sums[v] / counts[v];
}

/// Returns the rounds of averaging that reach about `radius`: each spreads by an edge, and spreads add up as squares.
int rounds_to_reach(double radius, const TriangleMesh& mesh) {
  double squares = 0;
  for (const Triangle& t : mesh.triangles)
    for (std::size_t k = 0; k < 3; ++k)
      squares += (mesh.positions[t[k]] - mesh.positions[t[(k + 1) % 3]]).cast<double>().squaredNorm();
  if (!(squares > 0)) return 0;
  const double rounds = radius * radius / (squares / (3 * static_cast<double>(mesh.triangles.size())));
  return static_cast<int>(std::min<double>(most_rounds, std::round(rounds)));
}

}  // namespace

std::vector<float> mean_curvature(const TriangleMesh& mesh, double radius) {
  // Vertices that hard edges have split are one.
  const std::vector<std::uint32_t> first = first_at_position(mesh.positions);
  const std::vector<Triangle> triangles = renumbered(mesh.triangles, first);
  Measures of = measure(mesh, triangles);
  for (int round = rounds_to_reach(radius, mesh); round > 0; --round) {
    average(of.curvature, triangles);
    average(of.area, triangles);
  }
  std::vector<float> curvature(mesh.positions.size());
  for (std::size_t v = 0; v < curvature.size(); ++v)
    if (of.area[first[v]] > 0) curvature[v] = static_cast<float>(of.curvature[first[v]] / of.area[first[v]]);
  return curvature;
}

}  // namespace kiln
