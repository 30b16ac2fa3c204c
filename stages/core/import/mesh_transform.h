// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace kiln {

/// Transform of a scene's node, for positions and normals of a mesh.
class MeshTransform {
 public:
  explicit MeshTransform(const Eigen::Matrix4d& world)
      : linear_(world.topLeftCorner<3, 3>()), offset_(world.topRightCorner<3, 1>()) {
    // Normals follow the inverse transpose. Up to a factor that is the cofactor matrix with the determinant's sign,
    // which exists for flat transforms as well.
    const Eigen::Vector3d x = linear_.col(0), y = linear_.col(1), z = linear_.col(2);
    cofactors_.col(0) = y.cross(z);
    cofactors_.col(1) = z.cross(x);
    cofactors_.col(2) = x.cross(y);
    is_mirror_ = linear_.determinant() < 0;
    if (is_mirror_) cofactors_ = -cofactors_;
  }

  /// Transforms a position; infinite where the transform or the position is too large.
  Eigen::Vector3d place(const Eigen::Vector3d& local) const { return linear_ * local + offset_; }

  /// Transforms a normal to a unit vector; zero where there is no direction.
  Eigen::Vector3f normal(const Eigen::Vector3d& local) const {
    return unit_or_zero(cofactors_ * unit_or_zero(local)).cast<float>();
  }

  /// Tells whether the transform reverses the order of corners.
  bool is_mirror() const { return is_mirror_; }

  /// Returns the largest length that one unit along an axis becomes.
  double largest_scale() const { return linear_.colwise().norm().maxCoeff(); }

 private:
  static Eigen::Vector3d unit_or_zero(const Eigen::Vector3d& v) {
    const double norm = v.stableNorm();
    return norm > 0 && std::isfinite(norm) ? Eigen::Vector3d(v / norm) : Eigen::Vector3d::Zero();
  }

  Eigen::Matrix3d linear_, cofactors_;
  Eigen::Vector3d offset_;
  bool is_mirror_ = false;
};

}  // namespace kiln
