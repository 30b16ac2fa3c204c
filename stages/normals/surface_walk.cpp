// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstring>
#include <tuple>

namespace kiln {

namespace {

constexpr std::uint32_t none = SurfacePoint::none;
constexpr int most_steps = 32;

/// Numbers the positions: equal bits get the same number.
std::vector<std::uint32_t> number_positions(const std::vector<Eigen::Vector3f>& positions) {
  std::vector<std::pair<std::array<std::uint32_t, 3>, std::uint32_t>> order(positions.size());
  for (std::uint32_t i = 0; i < order.size(); ++i) {
    std::memcpy(order[i].first.data(), positions[i].data(), 3 * sizeof(float));
    order[i].second = i;
  }
  std::sort(order.begin(), order.end());
  std::vector<std::uint32_t> number(positions.size());
  for (std::size_t i = 0; i < order.size(); ++i)
    number[order[i].second] =
        i > 0 && order[i].first == order[i - 1].first ? number[order[i - 1].second] : order[i].second;
  return number;
}

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleMesh& mesh)
    : mesh_(&mesh), neighbours_(mesh.triangles.size(), {none, none, none}) {
  const std::vector<std::uint32_t> number = number_positions(mesh.positions);
  struct Side {
    std::uint64_t key;  ///< both ends, the smaller first
    std::uint32_t triangle;
    std::uint32_t corner;
  };
  std::vector<Side> sides;
  sides.reserve(3 * mesh.triangles.size());
  for (std::uint32_t t = 0; t < mesh.triangles.size(); ++t)
    for (std::uint32_t k = 0; k < 3; ++k) {
      const auto [low, high] =
          std::minmax(number[mesh.triangles[t][(k + 1) % 3]], number[mesh.triangles[t][(k + 2) % 3]]);
      sides.push_back({(static_cast<std::uint64_t>(low) << 32) | high, t, k});
    }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::tie(a.key, a.triangle) < std::tie(b.key, b.triangle); });
  for (std::size_t begin = 0, end; begin < sides.size(); begin = end) {
    end = begin + 1;
    while (end < sides.size() && sides[end].key == sides[begin].key) ++end;
    if (end - begin != 2) continue;  // a border, or sheets that touch: walks stop there
    neighbours_[sides[begin].triangle][sides[begin].corner] = sides[begin + 1].triangle;
    neighbours_[sides[begin + 1].triangle][sides[begin + 1].corner] = sides[begin].triangle;
  }
}

SurfacePoint SurfaceWalk::meet(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, std::uint32_t start) const {
  std::uint32_t triangle = start, came_from = none;
  for (int step = 0; step < most_steps; ++step) {
    const Triangle& t = mesh_->triangles[triangle];
    const Eigen::Vector3f a = mesh_->positions[t[0]] - point, b = mesh_->positions[t[1]] - point,
                          c = mesh_->positions[t[2]] - point;
    // Signed volumes of the line and each edge are proportional to the weights of the opposite corners.
    const Eigen::Vector3f cn = c.cross(normal);
    const float of_a = b.dot(cn), of_b = -a.dot(cn), of_c = a.cross(b).dot(normal);
    const float sum = of_a + of_b + of_c;
    if (!(sum > 0)) return {};
    // Most points lie in the triangle of the one before.
    if (of_a >= 0 && of_b >= 0 && of_c >= 0) {
      const float u = of_b / sum, v = of_c / sum;
      return {triangle, u, v, (a + u * (b - a) + v * (c - a)).dot(normal)};
    }
    const std::array<float, 3> weights = {of_a, of_b, of_c};
    const auto least = static_cast<std::size_t>(std::min_element(weights.begin(), weights.end()) - weights.begin());
    // Within rounding of an edge either triangle will do; a walk must not oscillate between them.
    const std::uint32_t next = neighbours_[triangle][least];
    if (next == came_from && next != none && weights[least] > -1e-5f * sum) {
      const float u = of_b / sum, v = of_c / sum;
      return {triangle, u, v, (a + u * (b - a) + v * (c - a)).dot(normal)};
    }
    if (next == none) return {};
    came_from = triangle;
    triangle = next;
  }
  return {};
}

}  // namespace kiln
