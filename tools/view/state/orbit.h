// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "mesh/camera.h"

namespace kiln {

/// A camera that goes around a shape, which is given by its vertices. At the start (zoom 1, no pan, the angles of
/// `home`) it is kiln-render's camera.
struct Orbit {
  CameraSettings home;  ///< camera that just fits the whole shape; sets the target and the distance
  double azimuth_degrees = 20;
  double elevation_degrees = 12;
  double zoom = 1;                                ///< distance divided by that of `home`
  Eigen::Vector3d pan = Eigen::Vector3d::Zero();  ///< from the target of `home` to the point looked at, object units
};

/// Makes an orbit at its home.
Orbit home_orbit(const CameraSettings& home);

/// Turns by a drag in pixels (x to the right, y downwards): the surface follows the pointer.
void turn_orbit(Orbit& orbit, double right_pixels, double down_pixels);

/// Pans so that the point under the pointer stays there, if it is as far away as the point looked at.
void pan_orbit(Orbit& orbit, std::span<const Eigen::Vector3f> shape, double right_pixels, double down_pixels, int width,
               int height);

/// Zooms by steps of the wheel: one step forwards (above 0) goes a tenth nearer, within sensible limits.
void zoom_orbit(Orbit& orbit, double steps);

/// Returns the camera for a picture of width x height pixels.
Camera camera_of(const Orbit& orbit, std::span<const Eigen::Vector3f> shape, int width, int height);

}  // namespace kiln
