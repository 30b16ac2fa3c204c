// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "runtime/light/scene_lights.h"
#include "runtime/scene/scene_tree.h"
#include "sh/lights.h"

namespace kiln {

/// Ways to find the light that the other nodes of a scene leave to a node.
enum class ShadowMethod {
  none,  ///< all of it
};

struct ShadowSettings {
  ShadowMethod method = ShadowMethod::none;
  int directions = 1024;  ///< rays of a sample point
  int threads = 0;        ///< 0: all
};

/// What an asset is to shadows; object space.
struct ShadowObject {
  const TriangleMesh* mesh = nullptr;   ///< casts shadows
  std::vector<Eigen::Vector3f> points;  ///< receives them: incident-light samples, or all vertices
  int bands = 5;                        ///< of its transfer
};

/// Shadows that the nodes of a scene cast on each other while they move.
class MovingShadows {
 public:
  /// `objects` are the scene's assets, in the order that the tree's nodes name them; their meshes must live on.
  MovingShadows(SceneTree tree, std::vector<ShadowObject> objects, const ShadowSettings& settings);

  /// Computes the light at all points of all mesh nodes.
  void update(const ScenePoses& poses, const SceneLights& lights);

  /// Returns the light at the points of a mesh node, in its own space, three channels, as light_asset does where no
  /// other node stands.
  std::span<const LightCoefficients> light_of(int node) const { return light_[static_cast<std::size_t>(node)]; }

 private:
  SceneTree tree_;
  std::vector<ShadowObject> objects_;
  ShadowSettings settings_;
  std::vector<std::vector<LightCoefficients>> light_;  ///< by node and point
};

}  // namespace kiln
