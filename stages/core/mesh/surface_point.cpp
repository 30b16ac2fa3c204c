// SPDX-License-Identifier: MIT
#include "mesh/surface_point.h"

#include <Eigen/Geometry>

namespace kiln {

Eigen::Vector3f face_normal(const TriangleMesh& mesh, std::uint32_t triangle) {
  const Triangle& t = mesh.triangles[triangle];
  const Eigen::Vector3f a = mesh.positions[t[0]];
  return (mesh.positions[t[1]] - a).cross(mesh.positions[t[2]] - a).normalized();
}

Eigen::Vector3f position_at(const TriangleMesh& mesh, const SurfacePoint& point) {
  return interpolate(mesh, mesh.positions, point);
}

Eigen::Vector3f normal_at(const TriangleMesh& mesh, const SurfacePoint& point) {
  const auto sum = weigh_corners<Eigen::Vector3f>(
      point, [&](std::size_t k) -> const Eigen::Vector3f& { return corner_normal(mesh, point.triangle, k); });
  const float length = sum.norm();
  return length > 1e-6f ? Eigen::Vector3f(sum / length) : face_normal(mesh, point.triangle);
}

}  // namespace kiln
