// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

namespace kiln {

/// Incident radiance in spherical harmonics: coefficients[channel][i], channels of colour or of a spectral basis.
struct LightCoefficients {
  int bands = 0;
  std::vector<std::vector<float>> channels;
};

/// Returns a distant light in `direction` (towards the light) that gives a white surface that faces it the radiance
/// `colour`: the irradiance is pi times that. One channel per entry of `colour`.
LightCoefficients directional_light(int bands, const Eigen::Vector3f& direction, std::span<const float> color);

/// Returns the same radiance from everywhere (a furnace).
LightCoefficients constant_light(int bands, std::span<const float> radiance);

/// Projects a latitude-longitude picture of radiance, each pixel constant over its area. The basis is integrated over
/// pixels, exactly in azimuth and to rounding in elevation, so a picture of one pixel is an even sky. `pixels` has rows
/// from the bottom (-Y first), channels interleaved; u = atan2(z, x) / 2 pi + 1/2 runs to the right, v = elevation / pi
/// + 1/2 upwards (three.js' convention).
LightCoefficients latitude_longitude_light(int bands, int width, int height, int channels,
                                           std::span<const float> pixels);

/// Returns the radiance colour / sin^2(half_angle) from a cone of directions around `direction`, so that a white
/// surface that faces it has the radiance `colour` as long as the half-angle is at most 90 degrees; beyond, the
/// radiance is `colour`. `half_angle` in radians, 0 (a directional light) to pi (from everywhere).
LightCoefficients cone_light(int bands, const Eigen::Vector3f& direction, double half_angle,
                             std::span<const float> color);

/// Returns z_l of a cone light of colour 1, whose coefficients are z_l Y_lm(direction); for a half-angle of 0 those of
/// a directional light.
std::vector<double> cone_bands(int bands, double half_angle);

/// Returns the light of a glowing ball of `radius` around `position` (object units), as seen from the origin: the cone
/// light of the cap of sky that it covers. Inside the ball the light comes from everywhere.
LightCoefficients sphere_light(int bands, const Eigen::Vector3f& position, double radius, std::span<const float> color);

/// Returns radiance that changes from `ground` to `sky` with the cosine c to `up`: (1 + c) / 2 sky + (1 - c) / 2
/// ground.
LightCoefficients hemisphere_light(int bands, const Eigen::Vector3f& up, std::span<const float> sky,
                                   std::span<const float> ground);

/// Projects a cube map of radiance, each texel constant over its area: the basis is integrated over texels by products
/// of Gauss-Legendre rules, to 1e-6 of a texel's radiance or better. `faces` are +X, -X, +Y, -Y, +Z, -Z, each size x
/// size texels with channels interleaved, rows and columns as OpenGL lays out cube maps (OpenGL 4.5 core, table 8.19),
/// the first row being t = 0.
LightCoefficients cube_map_light(int bands, int size, int channels, std::span<const std::span<const float>, 6> faces);

/// Adds two lights, or scales one; all have the same number of bands and channels.
LightCoefficients add_lights(const LightCoefficients& a, const LightCoefficients& b);
LightCoefficients scale_light(const LightCoefficients& light, double factor);

/// Returns the integral over the sphere of the product of two functions: the dot product of their coefficients.
double dot_product(std::span<const float> f, std::span<const float> g);

/// Evaluates a function at a unit vector.
double evaluate_at(std::span<const float> coefficients, const Eigen::Vector3f& direction);

/// Returns the irradiance of a light as a function of the normal: band l times A_l (clamped_cosine_bands). Divided by
/// pi it is the exit radiance of an unshadowed white surface.
LightCoefficients irradiance(const LightCoefficients& light);

}  // namespace kiln
