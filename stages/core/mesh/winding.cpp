// SPDX-License-Identifier: MIT
#include "mesh/winding.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

namespace kiln {

namespace {

/// Returns half the solid angle of a triangle, seen from `point`.
double half_solid_angle(const TriangleMesh& mesh, const Triangle& triangle, const Eigen::Vector3d& point) {
  const Eigen::Vector3d a = mesh.positions[triangle[0]].cast<double>() - point;
  const Eigen::Vector3d b = mesh.positions[triangle[1]].cast<double>() - point;
  const Eigen::Vector3d c = mesh.positions[triangle[2]].cast<double>() - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  return std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
}

}  // namespace

double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point) {
  double sum = 0;
  for (const Triangle& triangle : mesh.triangles) sum += half_solid_angle(mesh, triangle, point);
  return sum / (2 * std::numbers::pi);
}

double winding_number(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles,
                      const Eigen::Vector3d& point) {
  double sum = 0;
  for (const std::uint32_t i : triangles) sum += half_solid_angle(mesh, mesh.triangles[i], point);
  return sum / (2 * std::numbers::pi);
}

}  // namespace kiln
