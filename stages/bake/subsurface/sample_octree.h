// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "bake/subsurface/surface_samples.h"

namespace kiln {

/// Surface samples in an octree. Nodes stand in the order of a walk that enters a node before its children.
struct SampleOctree {
  struct Node {
    Eigen::Vector3f centre;  ///< mean of the samples' positions, weighted by area
    float area = 0;          ///< area of all its samples
    Eigen::Vector3f lower, upper;
    std::uint32_t first = 0, last = 0;  ///< range of its samples in `order`; `last` is past the end
    std::uint32_t next = 0;             ///< node after all its children
    std::uint32_t parent = 0;           ///< the root's is the root itself
    bool is_leaf = false;
  };
  std::vector<Node> nodes;
  std::vector<std::uint32_t> order;  ///< samples along a Morton curve

  explicit SampleOctree(const SurfaceSamples& samples);
};

/// Returns the squared distance of a point from a node's box, 0 inside.
inline float squared_distance(const SampleOctree::Node& node, const Eigen::Vector3f& point) {
  return (node.lower - point).cwiseMax(point - node.upper).cwiseMax(0.f).squaredNorm();
}

}  // namespace kiln
