// SPDX-License-Identifier: MIT
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "base/parallel.h"
#include "runtime/light/scene_lights.h"
#include "runtime/scene/scene_tree.h"
#include "runtime/shadow/placed_nodes.h"

namespace kiln {

/// What a node's shadows follow from ([Chapter 2010], 5.3: dirtiness). Compared with what they were computed of, not
/// with the frame before, so that small steps do not add up unseen.
struct StateKey {
  std::vector<int> nodes;
  std::vector<double> numbers;

  /// Tests whether both are the same to rounding (1e-9).
  bool is_same(const StateKey& other) const;

  /// Renames nodes: node_now[node], or -1 for one that is no more. Of the nodes, the first two are no nodes (key_of).
  void rename(std::span<const int> node_now);
};

/// Returns the key of a node: its turn and scale, the places of `others` relative to it, their turns and scales, and
/// the version of the lights. Lengths count in `unit`. With local lights the node's own place counts, too.
StateKey key_of(int node, std::span<const int> others, const ScenePoses& poses, double unit, bool is_local,
                int lights_version);

/// Returns, for each node of a tree, which node of another one it is there, or -1: mesh nodes by name and asset,
/// composite nodes by the mesh nodes under them, the highest first.
std::vector<int> same_nodes(const SceneTree& tree, const SceneTree& other);

/// Adds a placement's turn and scale, and its `place` relative to something.
void add_place(StateKey& key, const Placement& pose, const Eigen::Vector3d& place, double unit);

/// Adds a ball (of `node`, relative to the place of the key's own node) to a key.
void add_ball(StateKey& key, int node, const BoundingBall& ball, const Placement& own, double unit);

/// Returns all numbers of lights, for comparing them.
std::vector<double> numbers_of(const SceneLights& lights);

/// Limits the number of threads, unless it is 0.
std::optional<ThreadLimit> limit_of(int threads);

}  // namespace kiln
