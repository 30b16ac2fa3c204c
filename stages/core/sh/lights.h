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

/// A distant light in `direction` (towards the light) that gives a white surface which faces it the radiance `colour`:
/// the irradiance is pi times that. One channel per entry of `colour`.
LightCoefficients directional_light(int bands, const Eigen::Vector3f& direction, std::span<const float> colour);

/// The same radiance from everywhere (a furnace).
LightCoefficients constant_light(int bands, std::span<const float> radiance);

/// A latitude-longitude picture of radiance, every pixel even over its area: the basis is integrated over pixels,
/// exactly in azimuth and to rounding in elevation, so that a picture of one pixel is an even sky. `pixels` has rows
/// from the bottom
/// (-Y first), channels interleaved; u = atan2(z, x) / 2 pi + 1/2 runs to the right, v = elevation / pi + 1/2 upwards
/// (three.js' convention).
LightCoefficients latitude_longitude_light(int bands, int width, int height, int channels,
                                           std::span<const float> pixels);

/// The radiance colour / sin^2(half_angle) from a cone of directions around `direction`, so that a white surface that
/// faces it has the radiance `colour` as long as the half-angle is at most 90 degrees; beyond, the radiance is
/// `colour`. `half_angle` in radians, 0 (a directional light) to pi (from everywhere).
LightCoefficients cone_light(int bands, const Eigen::Vector3f& direction, double half_angle,
                             std::span<const float> colour);

/// z_l of a cone light of colour 1, whose coefficients are z_l Y_lm(direction); of half-angle 0 those of a directional
/// light.
std::vector<double> cone_bands(int bands, double half_angle);

/// A glowing ball of `radius` around `position`, as seen from the origin (object units): the cone light of the cap that
/// it covers of the sky. Where the origin is inside the ball the light comes from everywhere.
LightCoefficients sphere_light(int bands, const Eigen::Vector3f& position, double radius,
                               std::span<const float> colour);

/// Radiance that goes from `ground` to `sky` with the cosine c to `up`: (1 + c) / 2 sky + (1 - c) / 2 ground.
LightCoefficients hemisphere_light(int bands, const Eigen::Vector3f& up, std::span<const float> sky,
                                   std::span<const float> ground);

/// A cube map of radiance, every texel even over its area: the basis is integrated over texels by products of
/// Gauss-Legendre rules, to 1e-6 of a texel's radiance or better. `faces` are +X,
/// -X, +Y, -Y, +Z, -Z, each size x size texels with channels interleaved, rows and columns as OpenGL lays out cube maps
/// (OpenGL 4.5 core, table 8.19), the first row being t = 0.
LightCoefficients cube_map_light(int bands, int size, int channels, std::span<const std::span<const float>, 6> faces);

/// The sum of two lights, and a light times a number; all of the same number of bands and channels.
LightCoefficients add_lights(const LightCoefficients& a, const LightCoefficients& b);
LightCoefficients scale_light(const LightCoefficients& light, double factor);

/// The integral over the sphere of the product of two functions: the dot product of their coefficients.
double dot_product(std::span<const float> f, std::span<const float> g);

/// The value of a function at a unit vector.
double evaluate_at(std::span<const float> coefficients, const Eigen::Vector3f& direction);

/// Irradiance, as a function of the normal, of a light: band l times A_l (clamped_cosine_bands). Divided by pi it is
/// the exit radiance of a white surface that nothing shadows.
LightCoefficients irradiance(const LightCoefficients& light);

}  // namespace kiln
