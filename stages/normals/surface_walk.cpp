// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/surface_walk.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <span>

#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"
#include "normals/part_scene.h"

namespace kiln {

namespace {

constexpr std::uint32_t none = SurfacePoint::none;
constexpr int most_steps = 32;

}  // namespace

SurfaceWalk::SurfaceWalk(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of)
    : mesh_(&mesh), neighbours_(mesh.triangles.size(), {none, none, none}) {
  const std::vector<Triangle> welded =
      taken_apart(renumbered(mesh.triangles, first_at_position(mesh.positions)), part_of);
  TriangleEdges(welded).for_each([&](std::span<const std::uint32_t> sides) {
    if (sides.size() != 2) return;  // a border, or sheets that touch: walks stop there
    neighbours_[sides[0] / 3][(sides[0] % 3 + 2) % 3] = sides[1] / 3;
    neighbours_[sides[1] / 3][(sides[1] % 3 + 2) % 3] = sides[0] / 3;
  });
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
