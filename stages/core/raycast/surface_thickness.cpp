// SPDX-License-Identifier: GPL-3.0-or-later
#include "raycast/surface_thickness.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

#include "base/parallel.h"
#include "sh/directions.h"

namespace kiln {

std::vector<float> surface_thickness(const RayScene& scene, const Receivers& points, int directions, float offset) {
  constexpr std::uint64_t seed = 1;
  std::vector<Eigen::Vector3f> inwards = sample_directions(Sampling::fibonacci, directions, seed);
  order_coherently(inwards);
  std::vector<float> thickness(points.size());
  constexpr std::size_t lanes = RayScene::PacketHits::lanes;
  // Neighbouring points share a packet of parallel rays.
  parallel_for(std::size_t{0}, (points.size() + lanes - 1) / lanes, [&](std::size_t packet) {
    const std::size_t first = packet * lanes, count = std::min(lanes, points.size() - first);
    float origin[3][lanes] = {}, distances[lanes];
    for (std::size_t k = 0; k < count; ++k)
      for (int axis = 0; axis < 3; ++axis) origin[axis][k] = points.positions[first + k][axis];
    std::array<double, lanes> lengths{}, weights{};
    for (const Eigen::Vector3f& direction : inwards) {
      std::array<float, lanes> cosines{};
      std::uint32_t rays = 0;
      for (std::size_t k = 0; k < count; ++k)
        if ((cosines[k] = -points.normals[first + k].dot(direction)) > 0) rays |= 1u << k;
      if (rays == 0) continue;
      scene.first_distances(origin, direction, rays, offset, distances);
      for (std::size_t k = 0; k < count; ++k) {
        if (!(cosines[k] > 0)) continue;
        weights[k] += static_cast<double>(cosines[k]);
        if (std::isfinite(distances[k])) lengths[k] += static_cast<double>(cosines[k] * distances[k]);
      }
    }
    for (std::size_t k = 0; k < count; ++k)
      if (weights[k] > 0) thickness[first + k] = static_cast<float>(lengths[k] / weights[k]);
  });
  return thickness;
}

}  // namespace kiln
