// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Place of an object in a scene: scaled uniformly, turned, then moved. Only uniform scales, so that angles and
/// directions of light are kept.
struct Placement {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  double scale = 1;  ///< above 0
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Eigen::Vector3d to_scene(const Eigen::Vector3d& object) const { return scale * (rotation * object) + translation; }
  Eigen::Vector3d to_object(const Eigen::Vector3d& scene) const {
    return rotation.transpose() * (scene - translation) / scale;
  }

  /// Returns the matrix (column vectors) from object space to the scene's.
  Eigen::Matrix4d matrix() const;

  bool turns() const { return !rotation.isIdentity(0); }
};

/// Reads "X,Y,Z[,AZIMUTH[,SCALE]]": the position of the object's origin, its turn about +Y (degrees; +Z turns towards
/// +X), and its scale. Throws WrongUsage, whose message calls the value `name`.
Placement parse_placement(std::string_view name, std::string_view text);

/// A turn about +Y, which turns +Z towards +X.
Eigen::Matrix3d turn_about_y(double degrees);

/// The box around a placed box.
BoundingBox placed_box(const BoundingBox& box, const Placement& placement);

}  // namespace kiln
