// SPDX-License-Identifier: MIT
#include "kiln/light.h"

#include <cmath>
#include <string>

#include "api/report_errors.h"
#include "asset/format.h"
#include "runtime/light/scene_lights.h"
#include "sh/light_spec.h"
#include "sh/lights.h"

namespace kiln::runtime {

namespace {

LightWindow window_of(Window window) {
  switch (window) {
    case Window::none:
      return LightWindow::none;
    case Window::lanczos:
      return LightWindow::lanczos;
    case Window::dering:
      return LightWindow::dering;
    case Window::hann:
      break;
  }
  return LightWindow::hann;
}

/// Adds a light whose numbers are in range.
void add(SceneLights& lights, const LightSpec& spec) {
  report_errors([&] { check_light_spec(spec); });
  lights.specs.push_back(spec);
}

}  // namespace

Light::Light(Window window) : lights_(std::make_unique<SceneLights>()) { lights_->window = window_of(window); }
Light::Light(const Light& other) : lights_(std::make_unique<SceneLights>(*other.lights_)) {}
Light& Light::operator=(const Light& other) {
  *lights_ = *other.lights_;
  return *this;
}
Light::~Light() = default;

Light& Light::directional(double azimuth_degrees, double elevation_degrees, const Color& radiance) {
  LightSpec spec;
  spec.azimuth_degrees = azimuth_degrees;
  spec.elevation_degrees = elevation_degrees;
  spec.color = radiance;
  add(*lights_, spec);
  return *this;
}

Light& Light::cone(double azimuth_degrees, double elevation_degrees, double half_angle_degrees, const Color& radiance) {
  LightSpec spec;
  spec.kind = LightSpec::Kind::cone;
  spec.azimuth_degrees = azimuth_degrees;
  spec.elevation_degrees = elevation_degrees;
  spec.half_angle_degrees = half_angle_degrees;
  spec.color = radiance;
  add(*lights_, spec);
  return *this;
}

Light& Light::ball(const std::array<double, 3>& position, double radius, const Color& radiance) {
  LightSpec spec;
  spec.kind = LightSpec::Kind::sphere;
  spec.position = position;
  spec.radius = radius;
  spec.color = radiance;
  add(*lights_, spec);
  return *this;
}

Light& Light::hemisphere(double azimuth_degrees, double elevation_degrees, const Color& sky, const Color& ground) {
  LightSpec spec;
  spec.kind = LightSpec::Kind::hemisphere;
  spec.azimuth_degrees = azimuth_degrees;
  spec.elevation_degrees = elevation_degrees;
  spec.color = sky;
  spec.ground = ground;
  add(*lights_, spec);
  return *this;
}

Light& Light::ambient(const Color& radiance) {
  LightSpec spec;
  spec.kind = LightSpec::Kind::ambient;
  spec.color = radiance;
  add(*lights_, spec);
  return *this;
}

Light& Light::from_text(std::string_view text) {
  report_errors([&] { lights_->specs.push_back(parse_light_spec(text)); });
  return *this;
}

Light& Light::latitude_longitude(int width, int height, std::span<const float> pixels) {
  const std::size_t expected = 3 * static_cast<std::size_t>(std::max(width, 0)) * std::max(height, 0);
  if (width < 1 || height < 1 || pixels.size() != expected)
    throw Error("Light::latitude_longitude: found " + std::to_string(pixels.size()) + " numbers for " +
                std::to_string(width) + " x " + std::to_string(height) + " pixels; expected three for each");
  for (const float value : pixels)
    if (!(value >= 0) || !std::isfinite(value))
      throw Error("Light::latitude_longitude: found " + std::to_string(value) +
                  "; expected radiance that is finite and not negative");
  const LightCoefficients light = latitude_longitude_light(most_asset_bands, width, height, 3, pixels);
  lights_->environment = lights_->environment ? add_lights(*lights_->environment, light) : light;
  return *this;
}

std::vector<float> Light::coefficients(int bands, const std::array<double, 3>& viewpoint) const {
  if (bands < 1 || bands > most_asset_bands)
    throw Error("Light::coefficients: found " + std::to_string(bands) + " bands; expected 1 to " +
                std::to_string(most_asset_bands));
  return report_errors([&] {
    const LightCoefficients light = lights_->incident(bands, {viewpoint[0], viewpoint[1], viewpoint[2]});
    std::vector<float> coefficients;
    for (const std::vector<float>& channel : light.channels)
      coefficients.insert(coefficients.end(), channel.begin(), channel.end());
    return coefficients;
  });
}

}  // namespace kiln::runtime
