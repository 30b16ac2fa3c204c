// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/receiver_tiles.h"

#include <algorithm>
#include <cmath>

namespace kiln {

std::vector<NormalCone> normal_cones(std::span<const Eigen::Vector3f> normals) {
  constexpr float rounding = 1e-5f;  // error of unit vectors and dot products in float32, with room
  std::vector<NormalCone> cones;
  for (std::size_t first = 0; first < normals.size(); first += tile_receivers) {
    const auto tile = normals.subspan(first, std::min(tile_receivers, normals.size() - first));
    Eigen::Vector3f sum = Eigen::Vector3f::Zero();
    for (const Eigen::Vector3f& normal : tile) sum += normal;
    NormalCone cone;
    if (sum.squaredNorm() > 0) {
      cone.axis = sum.normalized();
      float least_cosine = 1;
      for (const Eigen::Vector3f& normal : tile) least_cosine = std::min(least_cosine, cone.axis.dot(normal));
      if (least_cosine > 0) cone.sine = std::min(1.f, std::sqrt(1 - least_cosine * least_cosine) + rounding);
    }
    cones.push_back(cone);
  }
  return cones;
}

std::vector<TileBounds> tile_bounds(const Receivers& receivers, std::span<const NormalCone> cones) {
  std::vector<TileBounds> bounds;
  for (std::size_t tile = 0; tile < cones.size(); ++tile) {
    const std::size_t first = tile * tile_receivers;
    const auto points = receivers.positions.subspan(first, std::min(tile_receivers, receivers.size() - first));
    Eigen::Vector3f lower = points.front(), upper = points.front();
    for (const Eigen::Vector3f& point : points) {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    const Eigen::Vector3f centre = 0.5f * (lower + upper);
    float radius = 0;
    for (const Eigen::Vector3f& point : points) radius = std::max(radius, (point - centre).norm());
    bounds.push_back({{centre.x(), centre.y(), centre.z(), radius},
                      {cones[tile].axis.x(), cones[tile].axis.y(), cones[tile].axis.z(), cones[tile].sine}});
  }
  return bounds;
}

std::vector<std::uint32_t> facing_tiles(std::span<const NormalCone> cones, std::size_t receivers,
                                        std::span<const Eigen::Vector3f> directions, std::uint64_t& behind_pairs) {
  std::vector<std::uint32_t> facing;
  for (std::uint32_t tile = 0; tile < cones.size(); ++tile) {
    if (std::any_of(directions.begin(), directions.end(),
                    [&](const Eigen::Vector3f& direction) { return !cones[tile].faces_away(direction); }))
      facing.push_back(tile);
    else
      behind_pairs += std::min(tile_receivers, receivers - tile * tile_receivers) * directions.size();
  }
  return facing;
}

}  // namespace kiln
