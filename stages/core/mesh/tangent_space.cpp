// SPDX-License-Identifier: MIT
#include "mesh/tangent_space.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

namespace kiln {

namespace {

/// Returns `vector` without its part along the unit vector `normal`, normalised; zero where nothing is left.
Eigen::Vector3d in_plane(const Eigen::Vector3d& vector, const Eigen::Vector3d& normal) {
  const Eigen::Vector3d projected = vector - normal.dot(vector) * normal;
  const double length = projected.norm();
  return length > 0 ? Eigen::Vector3d(projected / length) : Eigen::Vector3d::Zero();
}

Eigen::Matrix3d matrix_of(const Eigen::Vector3f& normal, const TangentFrame& frame) {
  Eigen::Matrix3d matrix;
  matrix.col(0) = frame.tangent.cast<double>();
  matrix.col(2) = normal.cast<double>();
  matrix.col(1) = frame.sign * matrix.col(2).cross(matrix.col(0));
  return matrix;
}

}  // namespace

std::vector<TangentFrame> tangent_frames(const TriangleMesh& mesh) {
  const std::size_t count = mesh.positions.size();
  if (mesh.normals.size() != count || mesh.uvs.size() != count)
    throw std::invalid_argument("tangent_frames: the mesh needs normals and uvs");
  std::vector<Eigen::Vector3d> tangents(count, Eigen::Vector3d::Zero());
  std::vector<double> orientation(count, 0);

  for (const Triangle& triangle : mesh.triangles) {
    std::array<Eigen::Vector3d, 3> p;
    std::array<Eigen::Vector2d, 3> uv;
    for (int k = 0; k < 3; ++k) {
      p[k] = mesh.positions[triangle[k]].cast<double>();
      uv[k] = mesh.uvs[triangle[k]].cast<double>();
    }
    // dP/du of the face, up to a positive factor.
    const Eigen::Vector2d s = uv[1] - uv[0], t = uv[2] - uv[0];
    const double area = s.x() * t.y() - s.y() * t.x();
    if (area == 0) continue;
    const double sign = area > 0 ? 1 : -1;
    const Eigen::Vector3d along_u = sign * (t.y() * (p[1] - p[0]) - s.y() * (p[2] - p[0]));

    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d normal = mesh.normals[triangle[k]].cast<double>().normalized();
      const Eigen::Vector3d before = in_plane(p[(k + 2) % 3] - p[k], normal);
      const Eigen::Vector3d after = in_plane(p[(k + 1) % 3] - p[k], normal);
      const double angle = std::acos(std::clamp(before.dot(after), -1.0, 1.0));
      tangents[triangle[k]] += angle * in_plane(along_u, normal);
      orientation[triangle[k]] += angle * sign;
    }
  }

  std::vector<TangentFrame> frames(count);
  for (std::size_t i = 0; i < count; ++i) {
    const double length = tangents[i].norm();
    // Where no face gives a tangent, any direction in the plane will do.
    frames[i].tangent =
        length > 0 ? Eigen::Vector3f((tangents[i] / length).cast<float>()) : mesh.normals[i].unitOrthogonal();
    frames[i].sign = orientation[i] < 0 ? -1.0f : 1.0f;
  }
  return frames;
}

TangentFrame interpolate(const TriangleMesh& mesh, const std::vector<TangentFrame>& frames, const TexelSource& source) {
  const Triangle& t = mesh.triangles[source.triangle];
  const auto tangent = [&](std::size_t k) -> const Eigen::Vector3f& { return frames[t[k]].tangent; };
  return {weigh_corners<Eigen::Vector3f>(source, tangent), frames[t[0]].sign};
}

Eigen::Vector3f to_object_space(const Eigen::Vector3f& normal_tangent, const Eigen::Vector3f& normal,
                                const TangentFrame& frame) {
  return (matrix_of(normal, frame) * normal_tangent.cast<double>()).cast<float>();
}

Eigen::Vector3f to_tangent_space(const Eigen::Vector3f& normal_object, const Eigen::Vector3f& normal,
                                 const TangentFrame& frame) {
  const Eigen::Matrix3d matrix = matrix_of(normal, frame);
  // The tangent may have vanished between vertices whose frames disagree; the map can only say "up" there.
  constexpr double smallest_determinant = 1e-9;
  if (!(std::abs(matrix.determinant()) > smallest_determinant)) return Eigen::Vector3f::UnitZ();
  return (matrix.inverse() * normal_object.cast<double>()).normalized().cast<float>();
}

}  // namespace kiln
