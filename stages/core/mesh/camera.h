// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>

namespace kiln {

/// A pinhole camera that looks at a shape.
struct CameraSettings {
  double azimuth_degrees = 20;            ///< where the camera stands: 0 is +Z, the front; 90 is +X
  double elevation_degrees = 12;          ///< above the horizon
  double field_of_view_degrees = 30;      ///< vertical, before `zoom`
  double zoom = 1;                        ///< magnifies the middle of the picture; the camera stays where it is
  std::optional<Eigen::Vector3d> target;  ///< in the middle of the picture; none: the middle of the silhouette
  double distance = 0;                    ///< from the target; 0: as near as the whole silhouette allows
  double margin = 1.05;  ///< 1/margin is the part of the picture's tighter side that a fitted silhouette fills
};

/// Position and axes in object space; the picture's plane is at distance 1.
struct Camera {
  Eigen::Vector3f position;
  Eigen::Vector3f right;    ///< unit
  Eigen::Vector3f up;       ///< unit
  Eigen::Vector3f forward;  ///< unit
  float half_width = 1;     ///< half of the picture plane's width
  float half_height = 1;
  float near_distance = 0;  ///< depth range along `forward` of the part of the shape in front of the camera
  float far_distance = 0;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< point on the optical axis that the camera goes around

  /// Returns the unit vector through the centre of pixel (i, j), rows from the bottom.
  Eigen::Vector3f pixel_direction(int i, int j, int width, int height) const;

  /// Returns the matrix (column vectors) from object space to GL clip space.
  Eigen::Matrix4f clip_from_object() const;
};

/// Makes a camera for a picture of width x height pixels of a shape, given by its vertices (at least one). It stands as
/// near as possible with all of them in the picture and `margin` to spare: the shape then fills the picture either from
/// left to right or from top to bottom. Without a target the camera goes around the point of its axis that is as far
/// away as the middle of the vertices' box.
Camera make_camera(std::span<const Eigen::Vector3f> shape, const CameraSettings& settings, int width, int height);

}  // namespace kiln
