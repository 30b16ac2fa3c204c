// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/orbit.h"

#include <algorithm>
#include <cmath>

namespace kiln {

namespace {

constexpr double degrees_per_pixel = 0.4;
constexpr double nearest_zoom = 0.02, farthest_zoom = 20;

}  // namespace

Orbit home_orbit(const CameraSettings& home) {
  Orbit orbit;
  orbit.home = home;
  orbit.azimuth_degrees = home.azimuth_degrees;
  orbit.elevation_degrees = home.elevation_degrees;
  return orbit;
}

void turn_orbit(Orbit& orbit, double right_pixels, double down_pixels) {
  orbit.azimuth_degrees = std::remainder(orbit.azimuth_degrees - degrees_per_pixel * right_pixels, 360);
  orbit.elevation_degrees = std::clamp(orbit.elevation_degrees + degrees_per_pixel * down_pixels, -90.0, 90.0);
}

void pan_orbit(Orbit& orbit, std::span<const Eigen::Vector3f> shape, double right_pixels, double down_pixels, int width,
               int height) {
  const Camera camera = camera_of(orbit, shape, width, height);
  const double distance = (camera.position.cast<double>() - camera.target).norm();
  const double units_per_pixel = 2.0 * camera.half_height * distance / height;
  orbit.pan += units_per_pixel * (down_pixels * camera.up.cast<double>() - right_pixels * camera.right.cast<double>());
}

void zoom_orbit(Orbit& orbit, double steps) {
  orbit.zoom = std::clamp(orbit.zoom * std::pow(0.9, steps), nearest_zoom, farthest_zoom);
}

Camera camera_of(const Orbit& orbit, std::span<const Eigen::Vector3f> shape, int width, int height) {
  const Camera home = make_camera(shape, orbit.home, width, height);
  const bool is_home = orbit.zoom == 1 && orbit.pan.isZero(0) && orbit.azimuth_degrees == orbit.home.azimuth_degrees &&
                       orbit.elevation_degrees == orbit.home.elevation_degrees;
  if (is_home) return home;  // kiln-render's camera, to the bit
  CameraSettings settings = orbit.home;
  settings.azimuth_degrees = orbit.azimuth_degrees;
  settings.elevation_degrees = orbit.elevation_degrees;
  settings.target = home.target + orbit.pan;
  settings.distance = orbit.zoom * (home.position.cast<double>() - home.target).norm();
  return make_camera(shape, settings, width, height);
}

}  // namespace kiln
