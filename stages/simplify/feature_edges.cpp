// SPDX-License-Identifier: GPL-3.0-or-later
#include "simplify/feature_edges.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace kiln {

namespace {

Eigen::Vector3d unit_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const auto at = [&](int k) { return mesh.positions[mesh.triangles[triangle][k]].cast<double>().eval(); };
  return (at(1) - at(0)).cross(at(2) - at(0)).normalized();
}

/// Tells whether a mesh has a border. Around an inner vertex each neighbour follows one triangle and precedes another,
/// so that the sums of both are the same; at a border they are not, but for one chance in 2^64.
bool has_border(const TriangleMesh& mesh) {
  const auto scattered = [](std::uint64_t value) {  // Steele, Lea and Flood 2014 (SplitMix)
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

  // List each vertex's edges to larger ones with the triangles on them: count, then fill in.
  struct Side {
    std::uint32_t other, triangle;
  };
  std::vector<std::uint32_t> begin(mesh.positions.size() + 1, 0);
  const auto for_each = [&](const auto& visit) {
    for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i)
      for (int k = 0; k < 3; ++k) visit(std::minmax(mesh.triangles[i][k], mesh.triangles[i][(k + 1) % 3]), i);
  };
  for_each([&](const auto& edge, std::uint32_t) { ++begin[edge.first + 1]; });
  for (std::size_t i = 1; i < begin.size(); ++i) begin[i] += begin[i - 1];
  std::vector<Side> sides(begin.back());
  std::vector<std::uint32_t> next(begin.begin(), begin.end() - 1);
  for_each([&](const auto& edge, std::uint32_t i) { sides[next[edge.first]++] = {edge.second, i}; });

  const double smallest_cosine =
      crease_degrees > 0 ? std::cos(crease_degrees * std::numbers::pi / 180) : -2;  // below every cosine
  const auto is_crease = [&](std::uint32_t one, std::uint32_t other) {
    return smallest_cosine > -2 && unit_normal(mesh, one).dot(unit_normal(mesh, other)) < smallest_cosine;
  };
  std::vector<VertexPair> wanted;
  for (const auto& [a, b] : given) wanted.push_back(std::minmax(a, b));
  std::sort(wanted.begin(), wanted.end());
  std::vector<VertexPair> found;
  for (std::uint32_t vertex = 0; vertex < mesh.positions.size(); ++vertex) {
    const auto first = sides.begin() + begin[vertex], last = sides.begin() + begin[vertex + 1];
    std::sort(first, last, [](const Side& l, const Side& r) {
      return std::pair(l.other, l.triangle) < std::pair(r.other, r.triangle);
    });
    for (auto side = first; side != last;) {
      auto end = side + 1;
      while (end != last && end->other == side->other) ++end;
      const VertexPair edge{vertex, side->other};
      const bool is_border = end - side == 1;
      if (is_border || is_crease(side->triangle, (side + 1)->triangle) ||
          std::binary_search(wanted.begin(), wanted.end(), edge))
        found.push_back(edge);
      side = end;
    }
  }
  return found;
}

}  // namespace kiln
