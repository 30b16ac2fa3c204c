// SPDX-License-Identifier: MIT
#include "runtime/shadow/kept_state.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace kiln {

bool StateKey::is_same(const StateKey& other) const {
  constexpr double rounding = 1e-9;
  return nodes == other.nodes &&
         std::equal(numbers.begin(), numbers.end(), other.numbers.begin(), other.numbers.end(), [](double a, double b) {
           return std::abs(a - b) <= rounding * std::max({1.0, std::abs(a), std::abs(b)});
         });
}

StateKey key_of(int node, std::span<const int> others, const ScenePoses& poses, double unit, bool is_local,
                int lights_version) {
  StateKey key{{lights_version, is_local ? 1 : 0, node}, {}};
  key.nodes.insert(key.nodes.end(), others.begin(), others.end());
  const Placement& own = poses[static_cast<std::size_t>(node)];
  const auto add = [&](const Placement& pose, const Eigen::Vector3d& place) {
    for (int axis = 0; axis < 3; ++axis) key.numbers.push_back(place[axis] / unit);
    for (int k = 0; k < 9; ++k) key.numbers.push_back(pose.rotation(k / 3, k % 3));
    key.numbers.push_back(pose.scale / unit);
  };
  add(own, is_local ? own.translation : Eigen::Vector3d::Zero().eval());
  for (const int other : others) {
    const Placement& pose = poses[static_cast<std::size_t>(other)];
    add(pose, pose.translation - own.translation);
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
