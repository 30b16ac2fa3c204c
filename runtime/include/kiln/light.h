// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "kiln/asset.h"

namespace kiln {
struct SceneLights;
}

namespace kiln::runtime {

/// Weights of a light's bands against ringing (docs/format.md, "Light").
enum class Window { none, hann, lanczos, dering };

/// A sum of lights. Azimuth 0 is +Z, 90 is +X; elevation 90 is +Y. Colours are linear radiance: a white surface that
/// faces a directional light, a cone, or a ball seen from the origin has the radiance given, under every window and
/// number of bands. Every function that adds a light returns *this and throws Error for numbers out of range.
class KILN_RUNTIME_API Light {
 public:
  explicit Light(Window window = Window::hann);
  Light(const Light& other);
  Light& operator=(const Light& other);
  ~Light();

  Light& directional(double azimuth_degrees, double elevation_degrees, const Color& radiance = {1, 1, 1});
  /// Adds light from all directions within `half_angle_degrees`, 0 to 180, of one direction.
  Light& cone(double azimuth_degrees, double elevation_degrees, double half_angle_degrees,
              const Color& radiance = {1, 1, 1});
  /// Adds a glowing ball at a position (object units): the only light that depends on the viewpoint.
  Light& ball(const std::array<double, 3>& position, double radius, const Color& radiance = {1, 1, 1});
  /// Adds `sky` from the side of a direction and `ground` from the opposite side, mixed by the cosine in between.
  Light& hemisphere(double azimuth_degrees, double elevation_degrees, const Color& sky, const Color& ground);
  /// Adds the same radiance from everywhere.
  Light& ambient(const Color& radiance);
  /// Adds a light written as for kiln-render --light: "45,30", "sphere:1,2,1,0.1,1,0.9,0.8".
  Light& from_text(std::string_view text);
  /// Adds a latitude-longitude picture of radiance: three numbers per pixel, rows from the bottom (-Y first), u =
  /// atan2(z, x) / 2 pi + 1/2, like three.js. Represented in up to 24 bands.
  Light& latitude_longitude(int width, int height, std::span<const float> pixels);

  /// Computes the coefficients L_i of the light that arrives at `viewpoint` (object space), windowed: bands^2 numbers
  /// of red, then of green, then of blue.
  std::vector<float> coefficients(int bands, const std::array<double, 3>& viewpoint = {0, 0, 0}) const;

  /// Returns the library's own representation.
  const SceneLights& implementation() const { return *lights_; }

 private:
  std::unique_ptr<SceneLights> lights_;
};

}  // namespace kiln::runtime
