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
  double margin = 1.05;                   ///< of a picture that fits: the silhouette fills 1/margin of its tighter side
};

/// Position and axes in object space; the picture's plane is at distance 1.
struct Camera {
  Eigen::Vector3f position;
  Eigen::Vector3f right;    ///< unit
  Eigen::Vector3f up;       ///< unit
  Eigen::Vector3f forward;  ///< unit
  float half_width = 1;     ///< of the picture's plane
  float half_height = 1;
  float near_distance = 0;  ///< what is before the camera of the shape lies between these two along `forward`
  float far_distance = 0;
  Eigen::Vector3d target = Eigen::Vector3d::Zero();  ///< what it goes around: on the optical axis

  /// Unit vector through the centre of pixel (i, j), rows from the bottom.
  Eigen::Vector3f pixel_direction(int i, int j, int width, int height) const;

  /// Column-vector matrix from object space to GL clip space.
  Eigen::Matrix4f clip_from_object() const;
};

/// A camera for a picture of width x height pixels of a shape, given by its vertices (any number, one at least). As
/// near as all of them allow, projected, with `margin` to spare: of its two sides the picture is filled between left
/// and right, or between top and bottom. Without a target the camera goes around the point of its axis that is as far
/// away as the middle of the vertices' box.
Camera make_camera(std::span<const Eigen::Vector3f> shape, const CameraSettings& settings, int width, int height);

}  // namespace kiln
