// SPDX-License-Identifier: MIT
#include "runtime/shadow/kept_state.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <tuple>

namespace kiln {

bool StateKey::is_same(const StateKey& other) const {
  constexpr double rounding = 1e-9;
  return nodes == other.nodes &&
         std::equal(numbers.begin(), numbers.end(), other.numbers.begin(), other.numbers.end(), [](double a, double b) {
           return std::abs(a - b) <= rounding * std::max({1.0, std::abs(a), std::abs(b)});
         });
}

void StateKey::rename(std::span<const int> node_now) {
  for (std::size_t k = 2; k < nodes.size(); ++k)
    nodes[k] = nodes[k] < 0 ? -1 : node_now[static_cast<std::size_t>(nodes[k])];
}

std::vector<int> same_nodes(const SceneTree& tree, const SceneTree& other) {
  const auto leaf_of = [](const SceneNode& node) { return std::tuple(node.name, node.asset, node.is_static); };
  std::map<std::tuple<std::string, int, bool>, std::vector<int>> leaves;
  for (int k = 0; k < other.count(); ++k)
    if (other.nodes[static_cast<std::size_t>(k)].asset >= 0)
      leaves[leaf_of(other.nodes[static_cast<std::size_t>(k)])].push_back(k);
  std::vector<int> now(tree.nodes.size(), -1);
  std::map<int, int> before;
  for (int k = 0; k < tree.count(); ++k) {
    const auto found = leaves.find(leaf_of(tree.nodes[static_cast<std::size_t>(k)]));
    if (found == leaves.end() || found->second.size() != 1 || before.count(found->second[0]) > 0) continue;
    now[static_cast<std::size_t>(k)] = found->second[0];
    before[found->second[0]] = k;
  }
  // Composite nodes by what they hold, in the numbers of `other`; -1 is among them where one is no more.
  std::map<std::vector<int>, std::vector<int>> composites;
  for (int k = 0; k < other.count(); ++k)
    if (other.nodes[static_cast<std::size_t>(k)].asset < 0) {
      std::vector<int> held = meshes_under(other, k);
      std::sort(held.begin(), held.end());
      composites[held].push_back(k);
    }
  for (int k = 0; k < tree.count(); ++k) {
    if (tree.nodes[static_cast<std::size_t>(k)].asset >= 0) continue;
    std::vector<int> held = meshes_under(tree, k);
    for (int& node : held) node = now[static_cast<std::size_t>(node)];
    std::sort(held.begin(), held.end());
    const auto found = composites.find(held);
    if (found == composites.end() || found->second.empty()) continue;
    now[static_cast<std::size_t>(k)] = found->second.front();
    found->second.erase(found->second.begin());
  }
  return now;
}

void add_place(StateKey& key, const Placement& pose, const Eigen::Vector3d& place, double unit) {
  for (int axis = 0; axis < 3; ++axis) key.numbers.push_back(place[axis] / unit);
  for (int k = 0; k < 9; ++k) key.numbers.push_back(pose.rotation(k / 3, k % 3));
  key.numbers.push_back(pose.scale / unit);
}

StateKey key_of(int node, std::span<const int> others, const ScenePoses& poses, double unit, bool is_local,
                int lights_version) {
  StateKey key{{lights_version, is_local ? 1 : 0, node}, {}};
  key.nodes.insert(key.nodes.end(), others.begin(), others.end());
  const Placement& own = poses[static_cast<std::size_t>(node)];
  add_place(key, own, is_local ? own.translation : Eigen::Vector3d::Zero().eval(), unit);
  for (const int other : others) {
    const Placement& pose = poses[static_cast<std::size_t>(other)];
    add_place(key, pose, pose.translation - own.translation, unit);
  }
  return key;
}

void add_ball(StateKey& key, int node, const BoundingBall& ball, const Placement& own, double unit) {
  key.nodes.push_back(node);
  for (int axis = 0; axis < 3; ++axis) key.numbers.push_back((ball.centre - own.translation)[axis] / unit);
  key.numbers.push_back(ball.radius / unit);
}

std::vector<double> numbers_of(const SceneLights& lights) {
  std::vector<double> numbers = {static_cast<double>(lights.window),
                                 static_cast<double>(reinterpret_cast<std::uintptr_t>(lights.probes)),
                                 static_cast<double>(lights.specs.size())};
  for (const LightSpec& spec : lights.specs) {
    numbers.insert(numbers.end(), {static_cast<double>(spec.kind), spec.azimuth_degrees, spec.elevation_degrees,
                                   spec.half_angle_degrees, spec.radius});
    numbers.insert(numbers.end(), spec.position.begin(), spec.position.end());
    numbers.insert(numbers.end(), spec.color.begin(), spec.color.end());
    numbers.insert(numbers.end(), spec.ground.begin(), spec.ground.end());
  }
  if (lights.environment)
    for (const std::vector<float>& channel : lights.environment->channels)
      numbers.insert(numbers.end(), channel.begin(), channel.end());
  return numbers;
}

std::optional<ThreadLimit> limit_of(int threads) {
  if (threads <= 0) return std::nullopt;
  return std::optional<ThreadLimit>(std::in_place, static_cast<std::size_t>(threads));
}

}  // namespace kiln
