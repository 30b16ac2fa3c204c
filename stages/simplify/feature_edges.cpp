// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/feature_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

Eigen::Vector3d unit_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  return area_normal(mesh, mesh.triangles[triangle]).normalized();
}

/// Tells whether a mesh has a border. Around an inner vertex each neighbour follows one triangle and precedes another,
/// so that the sums of both are the same; at a border they are not, but for one chance in 2^64.
bool has_border(const TriangleMesh& mesh) {
  const auto scattered = [](std::uint64_t value) {  // SplitMix64 [Steele 2014]
    value = (value + 1) * 0x9e3779b97f4a7c15u;
    value = (value ^ value >> 30) * 0xbf58476d1ce4e5b9u;
    value = (value ^ value >> 27) * 0x94d049bb133111ebu;
    return value ^ value >> 31;
  };
  std::vector<std::uint64_t> sums(mesh.positions.size(), 0);
  for (const Triangle& t : mesh.triangles) {
    const std::uint64_t a = scattered(t[0]), b = scattered(t[1]), c = scattered(t[2]);
    sums[t[0]] += b - c;
    sums[t[1]] += c - a;
    sums[t[2]] += a - b;
  }
  return std::any_of(sums.begin(), sums.end(), [](std::uint64_t sum) { return sum != 0; });
}

}  // namespace

std::vector<VertexPair> find_feature_edges(const TriangleMesh& mesh, double crease_degrees,
                                           std::span<const VertexPair> given) {
  // Answer the usual case in one pass: a closed mesh, no angle, nothing given.
  if (crease_degrees <= 0 && given.empty() && !has_border(mesh)) return {};

  const double smallest_cosine =
      crease_degrees > 0 ? std::cos(crease_degrees * std::numbers::pi / 180) : -2;  // below every cosine
  const auto is_crease = [&](std::uint32_t one, std::uint32_t other) {
    return smallest_cosine > -2 && unit_normal(mesh, one).dot(unit_normal(mesh, other)) < smallest_cosine;
  };
  std::vector<VertexPair> wanted;
  for (const auto& [a, b] : given) wanted.emplace_back(std::minmax(a, b));
  std::sort(wanted.begin(), wanted.end());
  std::vector<VertexPair> found;
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    const VertexPair edge = edge_at(mesh.triangles, sides[0]);
    const bool is_border = sides.size() == 1;
    if (is_border || is_crease(sides[0] / 3, sides[1] / 3) || std::binary_search(wanted.begin(), wanted.end(), edge))
      found.push_back(edge);
  });
  return found;
}

}  // namespace kiln
