// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "runtime/shadow/moving_shadows.h"
#include "shapes.h"

namespace kiln {

/// A mesh node for make_tree: its asset, its parent, and whether it is static; a composite node has no asset.
struct NodeSketch {
  int parent = 0, asset = -1;
  bool is_static = false;
};

/// Makes a tree: the root, then `nodes` in order.
inline SceneTree make_tree(const std::vector<NodeSketch>& nodes) {
  SceneTree tree;
  tree.nodes.resize(nodes.size() + 1);
  tree.nodes[0].name = "root";
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    SceneNode& node = tree.nodes[k + 1];
    node.name = "node" + std::to_string(k + 1);
    node.parent = nodes[k].parent;
    node.asset = nodes[k].asset;
    node.is_static = nodes[k].is_static;
    tree.nodes[static_cast<std::size_t>(node.parent)].children.push_back(static_cast<int>(k) + 1);
  }
  return tree;
}

/// Places a node without turning it.
inline Placement placed_at(double x, double y, double z, double scale = 1) {
  Placement placement;
  placement.scale = scale;
  placement.translation = {x, y, z};
  return placement;
}

inline LightSpec ambient_light() {
  LightSpec light;
  light.kind = LightSpec::Kind::ambient;
  return light;
}

/// A cone of light from +Y, or a directional light for a half-angle of 0.
inline LightSpec light_from_above(double half_angle_degrees) {
  LightSpec light;
  light.kind = half_angle_degrees > 0 ? LightSpec::Kind::cone : LightSpec::Kind::directional;
  light.azimuth_degrees = 0;
  light.elevation_degrees = 90;
  light.half_angle_degrees = half_angle_degrees;
  return light;
}

/// Returns the largest difference between two lights' coefficients.
inline double largest_difference(const LightCoefficients& a, const LightCoefficients& b) {
  double largest = 0;
  for (std::size_t c = 0; c < a.channels.size(); ++c)
    for (std::size_t i = 0; i < a.channels[c].size(); ++i)
      largest =
          std::max(largest, std::abs(static_cast<double>(a.channels[c][i]) - static_cast<double>(b.channels[c][i])));
  return largest;
}

/// Returns the length of a light's coefficients.
inline double length_of(const LightCoefficients& light) {
  double sum = 0;
  for (const std::vector<float>& channel : light.channels)
    for (const float value : channel) sum += static_cast<double>(value) * static_cast<double>(value);
  return std::sqrt(sum);
}

}  // namespace kiln
