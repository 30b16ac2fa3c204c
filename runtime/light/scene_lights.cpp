// SPDX-License-Identifier: MIT
#include "runtime/light/scene_lights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "sh/basis.h"
#include "sh/directions.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

using Kind = LightSpec::Kind;

/// Returns the first bands of a light; bands that it lacks are 0.
LightCoefficients first_bands(const LightCoefficients& light, int bands) {
  LightCoefficients cut{bands, light.channels};
  for (std::vector<float>& channel : cut.channels) channel.resize(coefficient_count(bands));
  return cut;
}

/// Spreads grey light over functions; without a vector returns it as it is.
LightCoefficients in_functions(LightCoefficients grey, const Eigen::VectorXf* vector) {
  if (vector == nullptr) return grey;
  LightCoefficients light{grey.bands, {}};
  for (const float weight : *vector) {
    std::vector<float>& channel = light.channels.emplace_back(grey.channels.front());
    for (float& value : channel) value *= weight;
  }
  return light;
}

DirectLight direct_light(const LightSpec& spec, const Eigen::VectorXf* vector, const Placement& placement) {
  std::vector<float> radiance(spec.color.begin(), spec.color.end());
  if (vector != nullptr) {
    radiance.clear();
    for (const float weight : *vector) radiance.push_back(weight * spec.color[0]);
  }
  if (spec.kind != Kind::sphere) {
    const Eigen::Vector3d towards = direction_from_angles(spec.azimuth_degrees, spec.elevation_degrees).cast<double>();
    return {(placement.rotation.transpose() * towards).cast<float>(), 0, std::move(radiance)};
  }
  // Computes the ball's own radiance: a white surface at the scene's origin that faces it has the radiance `colour`.
  const Eigen::Vector3d position(spec.position.data());
  const double sine = std::min(1.0, spec.radius / position.norm());
  DirectLight light{placement.to_object(position).cast<float>(), static_cast<float>(spec.radius / placement.scale),
                    std::move(radiance)};
  for (float& value : light.radiance) value = static_cast<float>(value / (sine * sine));
  return light;
}

}  // namespace

bool is_direct(const LightSpec& spec) {
  return spec.kind == Kind::directional || spec.kind == Kind::sphere ||
         (spec.kind == Kind::cone && spec.half_angle_degrees <= 90);
}

bool SceneLights::is_local() const {
  return probes != nullptr ||
         std::any_of(specs.begin(), specs.end(), [](const LightSpec& spec) { return spec.kind == Kind::sphere; });
}

LightCoefficients SceneLights::incident(int bands, const Eigen::Vector3d& viewpoint) const {
  // Windows come last, so that they damp ringing of the light that arrives.
  const int source_bands = probes != nullptr ? std::max(bands, probes->bands) : bands,
            carried_bands = probes != nullptr ? std::min(bands, probes->bands) : bands;
  LightCoefficients sum = constant_light(bands, std::vector<float>(channels(), 0.f));
  const auto add = [&](LightCoefficients light, std::span<const double> weights) {
    if (probes != nullptr) light = light_at(*probes, viewpoint.cast<float>(), light);
    light = first_bands(light, carried_bands);
    apply_window(light, weights);
    sum = add_lights(sum, first_bands(light, bands));
  };
  for (std::size_t k = 0; k < specs.size(); ++k)
    add(in_functions(light_coefficients(specs[k], source_bands, viewpoint), vector_of(k)),
        window_weights(specs[k], carried_bands, window, viewpoint));
  if (environment)
    add(first_bands(*environment, source_bands), window_weights(first_bands(*environment, carried_bands), window));
  return sum;
}

AssetLight light_asset(const SceneLights& lights, int bands, const Placement& placement,
                       std::span<const Eigen::Vector3f> points) {
  AssetLight light;
  const ShRotation into_object(bands, placement.rotation.transpose());
  for (const Eigen::Vector3f& point : points) {
    const LightCoefficients incident = lights.incident(bands, placement.to_scene(point.cast<double>()));
    light.samples.push_back(placement.turns() ? into_object(incident) : incident);
  }
  SceneLights others{{}, lights.environment, LightWindow::none};
  for (std::size_t k = 0; k < lights.specs.size(); ++k) {
    const LightSpec& spec = lights.specs[k];
    if (is_direct(spec)) {
      light.direct.push_back(direct_light(spec, lights.vector_of(k), placement));
      continue;
    }
    others.specs.push_back(spec);
    if (lights.vector_of(k) != nullptr) others.vectors.push_back(*lights.vector_of(k));
  }
  // Darkness has as many channels.
  if (others.specs.empty() && !lights.vectors.empty()) {
    others.specs.push_back({.kind = Kind::ambient, .color = {0, 0, 0}});
    others.vectors.push_back(lights.vectors.front());
  }
  constexpr int rest_bands = 3;
  light.rest = ShRotation(rest_bands, placement.rotation.transpose())(others.incident(rest_bands, {0, 0, 0}));
  return light;
}

}  // namespace kiln
