#pragma once

#include <Eigen/Core>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// A pinhole camera outside a box that looks at its centre, as near as the whole box allows.
struct CameraSettings {
  double azimuth_degrees = 20;        ///< where the camera stands: 0 is +Z, 90 is +X
  double elevation_degrees = 12;      ///< above the horizon
  double field_of_view_degrees = 30;  ///< vertical
  double margin = 1.06;               ///< the box' bounding sphere fills 1/margin of the picture's shorter side
  double least_distance = 0;          ///< from the box' centre, object units
};

/// Position and axes in object space; the picture's plane is at distance 1.
struct Camera {
  Eigen::Vector3f position;
  Eigen::Vector3f right;    ///< unit
  Eigen::Vector3f up;       ///< unit
  Eigen::Vector3f forward;  ///< unit
  float half_width = 1;     ///< of the picture's plane
  float half_height = 1;
  float near_distance = 0;  ///< the box lies between these two along `forward`
  float far_distance = 0;

  /// Unit vector through the centre of pixel (i, j), rows from the bottom.
  Eigen::Vector3f pixel_direction(int i, int j, int width, int height) const;

  /// Column-vector matrix from object space to GL clip space.
  Eigen::Matrix4f clip_from_object() const;
};

/// A camera that shows all of `box` in a picture of width x height pixels.
Camera make_camera(const BoundingBox& box, const CameraSettings& settings, int width, int height);

}  // namespace kiln
