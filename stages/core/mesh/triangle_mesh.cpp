// SPDX-License-Identifier: MIT
#include "mesh/triangle_mesh.h"

#include <Eigen/Geometry>
#include <cmath>
#include <cstdlib>

#include "mesh/triangle_edges.h"

namespace kiln {

int ordinary_exponent(double longest_side) {
  constexpr int largest = 20;  // a million, as a power of two
  if (!(longest_side > 0) || !std::isfinite(longest_side)) return 0;
  const int exponent = std::ilogb(longest_side);
  return std::abs(exponent) > largest ? exponent : 0;
}

BoundingBox bounding_box(const TriangleMesh& mesh) {
  BoundingBox box;
  for (const Triangle& triangle : mesh.triangles)
    for (std::uint32_t vertex : triangle) box.extend(mesh.positions[vertex]);
  return box;
}

BoundingBox bounding_box(std::span<const Eigen::Vector3f> points) {
  BoundingBox box;
  for (const Eigen::Vector3f& point : points) box.extend(point);
  return box;
}

void compute_vertex_normals(TriangleMesh& mesh) {
  std::vector<Eigen::Vector3d> sums(mesh.positions.size(), Eigen::Vector3d::Zero());
  for (const Triangle& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> corner;
    for (int i = 0; i < 3; ++i) corner[i] = mesh.positions[triangle[i]].cast<double>();
    const Eigen::Vector3d cross = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
    const double length = cross.norm();
    if (!(length > 0)) continue;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d a = corner[(i + 1) % 3] - corner[i];
      const Eigen::Vector3d b = corner[(i + 2) % 3] - corner[i];
      sums[triangle[i]] += std::atan2(length, a.dot(b)) / length * cross;
    }
  }
  mesh.corner_normals.clear();
  mesh.normals.resize(mesh.positions.size());
  for (std::size_t i = 0; i < sums.size(); ++i) {
    const double length = sums[i].norm();
    mesh.normals[i] = length > 0 ? Eigen::Vector3f((sums[i] / length).cast<float>()) : Eigen::Vector3f::UnitY();
  }
}

void append(TriangleMesh& whole, const TriangleMesh& part) {
  const auto first = static_cast<std::uint32_t>(whole.positions.size());
  whole.positions.insert(whole.positions.end(), part.positions.begin(), part.positions.end());
  for (const auto& [a, b, c] : part.triangles) whole.triangles.push_back({first + a, first + b, first + c});
}

Eigen::Vector3d area_normal(const TriangleMesh& mesh, const Triangle& triangle) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>();
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>();
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>();
  return (b - a).cross(c - a);
}

bool is_flat(const TriangleMesh& mesh, const Triangle& triangle) { return area_normal(mesh, triangle).isZero(0); }

bool is_closed(const TriangleMesh& mesh) {
  bool closed = true;
  TriangleEdges(mesh.triangles).for_each([&](std::span<const std::uint32_t> sides) {
    closed = closed && sides.size() == 2 && run_opposite(mesh.triangles, sides[0], sides[1]);
  });
  return closed;
}

double surface_area(const TriangleMesh& mesh) {
  double area = 0;
  for (const Triangle& triangle : mesh.triangles) area += 0.5 * area_normal(mesh, triangle).norm();
  return area;
}

}  // namespace kiln
