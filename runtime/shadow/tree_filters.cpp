// SPDX-License-Identifier: MIT
#include "runtime/shadow/tree_filters.h"

#include <array>
#include <cmath>
#include <cstdint>
#include <numbers>

#include "sh/basis.h"
#include "sh/product.h"
#include "sh/windows.h"

namespace kiln {

namespace {

const SceneNode& node_of(const SceneTree& tree, int node) { return tree.nodes[static_cast<std::size_t>(node)]; }

}  // namespace

SiblingOccluders sibling_occluders(const ShadowStage& stage, int node, bool composite_balls, bool for_static) {
  SiblingOccluders found;
  const int parent = node_of(stage.tree, node).parent;
  if (parent < 0) return found;
  const BoundingBall& own = stage.place_of(node).ball;
  for (const int sibling : node_of(stage.tree, parent).children) {
    const PlacedNode& place = stage.place_of(sibling);
    if (sibling == node || place.ball.radius < 0) continue;
    const bool is_clear = (place.ball.centre - own.centre).norm() > place.ball.radius + own.radius;
    if (composite_balls && is_clear && node_of(stage.tree, sibling).asset < 0 && !(for_static && place.has_static)) {
      found.balls.push_back(sibling);
      continue;
    }
    for (const int mesh : meshes_under(stage.tree, sibling))
      if (!(for_static && node_of(stage.tree, mesh).is_static)) found.meshes.push_back(mesh);
  }
  return found;
}

BlockedSum blocked_by(const ShadowStage& stage, const SiblingOccluders& siblings, const Eigen::Vector3d& point) {
  thread_local std::vector<std::uint8_t> blocked;
  thread_local std::vector<std::uint32_t> tested;
  blocked.assign(stage.sky.count(), 0);
  const auto find = [&](int occluder) {
    const ViewCone cone = cone_of(stage.place_of(occluder).ball, point);
    tested.clear();
    find_in_cone(stage.sky, cone.axis.cast<float>(), static_cast<float>(cone.half_angle), blocked, tested);
  };
  for (const int ball : siblings.balls) {
    find(ball);
    for (const std::uint32_t d : tested) blocked[d] = 1;
  }
  for (const int mesh : siblings.meshes) {
    find(mesh);
    if (!tested.empty()) stage.mesh_of(mesh).block(stage.pose_of(mesh), point, stage.sky, tested, {}, blocked);
  }
  BlockedSum sum;
  for (std::uint32_t d = 0; d < stage.sky.count(); ++d) {
    if (blocked[d] == 0) continue;
    sum.resize(static_cast<std::size_t>(stage.sky.coefficients), 0.0);
    const std::span<const float> row = stage.sky.row(d);
    for (std::size_t i = 0; i < row.size(); ++i) sum[i] += static_cast<double>(row[i]);
  }
  for (double& value : sum) value *= 4 * std::numbers::pi / stage.sky.count();
  return sum;
}

std::vector<float> filter_of(const BlockedSum& blocked) {
  std::vector<float> filter;
  for (const double value : blocked) filter.push_back(static_cast<float>(-value));
  if (!filter.empty()) filter[0] = static_cast<float>(std::sqrt(4 * std::numbers::pi) - blocked[0]);
  return filter;
}

LightCoefficients filtered_light(ShadowMethod method, const LightCoefficients& light, std::span<const float> filter) {
  LightCoefficients result = light;
  if (method == ShadowMethod::subtraction) {
    const double unit = std::sqrt(4 * std::numbers::pi);
    for (std::vector<float>& channel : result.channels) {
      const double mean = static_cast<double>(channel[0]) / unit;
      for (std::size_t i = 0; i < channel.size(); ++i) {
        const double lacking = (i == 0 ? unit : 0) - static_cast<double>(filter[i]);
        channel[i] = static_cast<float>(static_cast<double>(channel[i]) - mean * lacking);
      }
    }
    return result;
  }
  std::vector<float> weighted(filter.begin(), filter.end());
  if (method == ShadowMethod::thesis) {
    const std::vector<double> window = hann_window(light.bands);
    for (std::size_t i = 0; i < weighted.size(); ++i)
      weighted[i] = static_cast<float>(static_cast<double>(weighted[i]) *
                                       window[static_cast<std::size_t>(band_of(static_cast<int>(i)))]);
  }
  const ShProduct& product = ShProduct::of_bands(light.bands);
  for (std::size_t c = 0; c < result.channels.size(); ++c) result.channels[c] = product(light.channels[c], weighted);
  return result;
}

LightCoefficients product_of_many_bands(const SceneLights& lights, std::span<const float> filter, int bands,
                                        const Eigen::Vector3d& position) {
  const int many = band_of(static_cast<int>(filter.size()) - 1) + 1;
  const ShProduct& product = ShProduct::of_bands(many, bands);
  LightCoefficients sum = constant_light(bands, std::array<float, 3>{0, 0, 0});
  for (const WindowedLight& part : windowed_lights(lights, many, bands, position)) {
    LightCoefficients shadowed{bands, {}};
    for (const std::vector<float>& channel : part.light.channels) shadowed.channels.push_back(product(channel, filter));
    apply_window(shadowed, part.window);
    sum = add_lights(sum, shadowed);
  }
  return sum;
}

}  // namespace kiln
