// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "sh/lights.h"
#include "sh/windows.h"

namespace kiln {

/// A light as a person writes it down: colour in linear RGB.
struct LightSpec {
  enum class Kind {
    directional,  ///< distant, towards azimuth and elevation; a white surface that faces it gets the radiance `colour`
    cone,         ///< the same from a cone of directions around it (cone_light)
    sphere,       ///< a glowing ball at `position` (sphere_light): a local light
    hemisphere,   ///< `colour` from the side of azimuth and elevation, `ground` from the other (hemisphere_light)
    ambient,      ///< the radiance `colour` from everywhere (a furnace)
  };
  Kind kind = Kind::directional;
  double azimuth_degrees = 45;                 ///< 0 is +Z, 90 is +X
  double elevation_degrees = 30;               ///< 90 is +Y
  double half_angle_degrees = 10;              ///< half-angle of a cone
  std::array<double, 3> position = {0, 0, 0};  ///< centre of a ball, object units
  double radius = 1;                           ///< radius of a ball, object units
  std::array<float, 3> color = {1, 1, 1};
  std::array<float, 3> ground = {0, 0, 0};
};

/// Reads a light. Angles are in degrees; the colour may be left out, and is white then:
///   [directional:]AZIMUTH,ELEVATION[,R,G,B]
///   cone:AZIMUTH,ELEVATION,HALF-ANGLE[,R,G,B]
///   sphere:X,Y,Z,RADIUS[,R,G,B]
///   hemisphere:AZIMUTH,ELEVATION,R,G,B,R,G,B   the second colour is the ground's
///   ambient:RADIANCE or ambient:R,G,B
/// Azimuths of -360 to 360, elevations of -90 to 90, half-angles of 0 to 180, colours of 0 to 1e6. Throws WrongUsage.
LightSpec parse_light_spec(std::string_view text);

/// Throws WrongUsage unless the numbers of a light are in the ranges that parse_light_spec states.
void check_light_spec(const LightSpec& spec);

/// Writes a text that parse_light_spec reads as the same light.
std::string to_text(const LightSpec& spec);

/// Returns the light in spherical harmonics as it arrives at `viewpoint`, three channels (R, G, B), without a window.
/// Only a ball depends on the viewpoint: its own radiance is constant, so its irradiance falls with the square of the
/// distance, and is such that a white surface that faces it has the radiance `colour` at the origin.
LightCoefficients light_coefficients(const LightSpec& spec, int bands,
                                     const Eigen::Vector3d& viewpoint = Eigen::Vector3d::Zero());

/// Returns the factors of that light's bands under `window`: the window's weights, scaled so that a white surface that
/// faces the light has the radiance that LightSpec gives, for every window and number of bands (axial_weights; per
/// light, so that light stays a sum). Ambient light, of band 0 alone, and hemispheres, which have two bands and do not
/// ring, keep factors of 1.
std::vector<double> window_weights(const LightSpec& spec, int bands, LightWindow window,
                                   const Eigen::Vector3d& viewpoint = Eigen::Vector3d::Zero());

/// Returns light_coefficients times window_weights.
LightCoefficients windowed_light(const LightSpec& spec, int bands, LightWindow window,
                                 const Eigen::Vector3d& viewpoint = Eigen::Vector3d::Zero());

/// Returns the sum of the lights, three channels, each windowed.
LightCoefficients light_coefficients(std::span<const LightSpec> specs, int bands, LightWindow window);

}  // namespace kiln
