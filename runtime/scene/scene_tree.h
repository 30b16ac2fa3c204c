// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "mesh/placement.h"

namespace kiln {

/// Node of a scene: a composite node, which has children, or a mesh node, which stands for an asset ([Chapter 2010],
/// 5.1.4).
struct SceneNode {
  std::string name;
  int parent = -1;            ///< index of a node; -1: none, this is the root
  std::vector<int> children;  ///< indices of nodes; of composite nodes alone
  int asset = -1;             ///< index among the scene's assets; -1: a composite node
  bool is_static = false;     ///< whether bakes of the scene's other static nodes have its shadow
};

/// Tree of a scene's nodes. The first is the root, a composite node; each stands behind its parent.
struct SceneTree {
  std::vector<SceneNode> nodes;

  int count() const { return static_cast<int>(nodes.size()); }
};

/// Places of a tree's nodes at one moment, from each one's own space to the scene's, in the order of the nodes.
using ScenePoses = std::vector<Placement>;

}  // namespace kiln
