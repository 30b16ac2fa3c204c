// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "mesh/camera.h"

namespace kiln {

/// A camera that goes around a shape, which is given by its vertices. As it starts (zoom 1, no pan, the angles of
/// `home`) it is kiln-render's camera.
struct Orbit {
  CameraSettings home;  ///< at its angles all of the shape is just in the picture; they set the target and the distance
  double azimuth_degrees = 20;
  double elevation_degrees = 12;
  double zoom = 1;                                ///< the distance over that of `home`
  Eigen::Vector3d pan = Eigen::Vector3d::Zero();  ///< of the point looked at from the target of `home`, object units
};

/// An orbit that stands at its home.
Orbit home_orbit(const CameraSettings& home);

/// Drags by pixels (x to the right, y downwards): what is dragged follows the pointer.
void turn_orbit(Orbit& orbit, double right_pixels, double down_pixels);

/// The point under the pointer stays under it, where it is as far away as the point looked at.
void pan_orbit(Orbit& orbit, std::span<const Eigen::Vector3f> shape, double right_pixels, double down_pixels, int width,
               int height);

/// One step of the wheel, forwards above 0, goes a tenth nearer; never nearer or farther than makes sense.
void zoom_orbit(Orbit& orbit, double steps);

/// The camera for a picture of width x height pixels.
Camera camera_of(const Orbit& orbit, std::span<const Eigen::Vector3f> shape, int width, int height);

}  // namespace kiln
