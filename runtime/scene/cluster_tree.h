// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "runtime/scene/scene_tree.h"

namespace kiln {

/// Sphere around a mesh node, in the scene's space.
struct NodeSphere {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = 0;
};

/// Tree that groups mesh nodes by their bounding spheres, and keeps up with them as they move: what [Chapter 2010],
/// 5.1.3, leaves to the programmer and names as future work.
///
/// Two groups are as far apart as the distance of their spheres' centres over the sum of the radii: 1 where these
/// touch. Groups are merged in three rounds, the nearest two first, until none are nearer than 1, 2 and 4; the groups
/// of a round are the children of those of the next, and what is left after the last stands directly beneath the root.
/// A group stays together until it comes apart by a quarter more than it needed to form, so that a node that hovers
/// about the border does not change the tree with every frame.
class ClusterTree {
 public:
  /// `leaves` are the mesh nodes; of each its name, asset and is_static count.
  explicit ClusterTree(std::vector<SceneNode> leaves);

  /// Groups the leaves by where they are now, one sphere for each. Returns whether the tree has changed.
  bool update(std::span<const NodeSphere> spheres);

  const SceneTree& tree() const { return tree_; }
  /// Returns the index in the tree of a leaf.
  int node_of(int leaf) const { return node_of_[static_cast<std::size_t>(leaf)]; }

 private:
  void build();
  void add(int parent, std::size_t level, const std::vector<int>& leaves);

  std::vector<SceneNode> leaves_;
  std::vector<std::vector<int>> labels_;  ///< by round and leaf: the first leaf of its group
  SceneTree tree_;
  std::vector<int> node_of_;
};

}  // namespace kiln
