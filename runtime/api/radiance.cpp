// SPDX-License-Identifier: MIT
#include "kiln/radiance.h"

#include <algorithm>
#include <numeric>
#include <string>

#include "base/parallel.h"
#include "sh/lights.h"

namespace kiln::runtime {

namespace {

/// Throws unless `light` fits the asset. Returns the number of coefficients per colour of the light.
std::size_t require_light(const Asset& asset, std::span<const float> light) {
  const auto coefficients = static_cast<std::size_t>(asset.bands()) * static_cast<std::size_t>(asset.bands());
  if (light.size() != 3 * coefficients)
    throw Error("exit_radiance: found a light of " + std::to_string(light.size()) + " numbers; expected " +
                std::to_string(3 * coefficients) + ", three colours in " + std::to_string(asset.bands()) +
                " bands; call Light::coefficients with the asset's bands");
  if (asset.channels() != 1 && asset.channels() != 3)
    throw Error("exit_radiance: found an asset of " + std::to_string(asset.channels()) +
                " channels; expected 1 or 3: others are spectral, and need sensor matrices to become colours");
  return coefficients;
}

Color lit(const Asset& asset, std::span<const float> light, std::span<const float> vector, std::size_t coefficients) {
  Color radiance;
  for (std::size_t color = 0; color < 3; ++color)
    radiance[color] =
        static_cast<float>(dot_product(light.subspan(color * coefficients, coefficients),
                                       vector.subspan(asset.channels() == 1 ? 0 : color * coefficients, coefficients)));
  return radiance;
}

}  // namespace

std::vector<float> exit_radiance(const Asset& asset, std::span<const float> light, const std::optional<Color>& albedo) {
  const std::size_t coefficients = require_light(asset, light), length = asset.vector_length();
  std::vector<float> radiance(3 * asset.points());
  constexpr std::size_t most_at_once = 4096;
  parallel_ranges(0, asset.points(), most_at_once, [&](std::size_t begin, std::size_t end) {
    for (std::size_t first = begin; first < end; first += most_at_once) {
      std::vector<std::uint32_t> points(std::min(most_at_once, end - first));
      std::iota(points.begin(), points.end(), static_cast<std::uint32_t>(first));
      std::vector<float> vectors(points.size() * length);
      asset.transfer(points, vectors);
      for (std::size_t k = 0; k < points.size(); ++k) {
        const Color sum = lit(asset, light, std::span(vectors).subspan(k * length, length), coefficients);
        const Color share = albedo ? *albedo : asset.albedo(points[k]);
        for (std::size_t color = 0; color < 3; ++color) radiance[3 * points[k] + color] = share[color] * sum[color];
      }
    }
  });
  return radiance;
}

Color exit_radiance_at(const Asset& asset, std::span<const float> light, std::uint32_t point,
                       const std::optional<Color>& albedo) {
  const std::size_t coefficients = require_light(asset, light);
  std::vector<float> vector(asset.vector_length());
  asset.transfer({&point, 1}, vector);
  Color radiance = lit(asset, light, vector, coefficients);
  const Color share = albedo ? *albedo : asset.albedo(point);
  for (std::size_t color = 0; color < 3; ++color) radiance[color] *= share[color];
  return radiance;
}

}  // namespace kiln::runtime
