// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "runtime/light/scene_lights.h"
#include "runtime/scene/scene_tree.h"
#include "runtime/shadow/shadow_settings.h"
#include "runtime/shadow/visibility_engine.h"
#include "sh/lights.h"

namespace kiln {

/// What an asset is to shadows; object space.
struct ShadowObject {
  const TriangleMesh* mesh = nullptr;    ///< casts shadows
  std::vector<Eigen::Vector3f> points;   ///< receives them: incident-light samples, or all vertices
  int bands = 5;                         ///< of its transfer
  std::vector<Eigen::Vector3f> normals;  ///< of the points; empty: light may come from all sides
};

/// Shadows that the nodes of a scene cast on each other while they move.
class MovingShadows {
 public:
  /// `objects` are the scene's assets, in the order that the tree's nodes name them; their meshes must live on. Builds
  /// what the method needs of each: hierarchies for rays, balls that stand for it, fields of visibility. `engine` finds
  /// what is blocked for `combined`, in place of rays, unless the lights have probes; no other method asks it.
  MovingShadows(SceneTree tree, std::vector<ShadowObject> objects, const ShadowSettings& settings,
                std::shared_ptr<VisibilityEngine> engine = nullptr);
  ~MovingShadows();
  MovingShadows(MovingShadows&&) noexcept;
  MovingShadows& operator=(MovingShadows&&) noexcept;

  /// Takes another tree of the same mesh nodes, or nearly: those of the same name and asset. What was computed of them
  /// is kept where it still holds; a composite node is the same as one that held the same nodes.
  void set_tree(SceneTree tree);

  /// Computes the light at all points of all mesh nodes. What has not changed is kept: of `exponentiation` and `fields`
  /// a node's light, as long as the lights, its own place in them, and the places relative to it of all nodes that may
  /// take light from it are the same to rounding; of `combined` also that of each point before whose lights nothing
  /// moves, and at the others the directions that are blocked by what stands still; of the filters of trees (`thesis`,
  /// `product`, `subtraction`) what siblings block. No bit depends on the number of threads, or on what was kept.
  void update(const ScenePoses& poses, const SceneLights& lights);

  /// Returns the light at the points of a mesh node, in its own space, three channels, as light_asset does where no
  /// other node stands: the same to the bit where none takes light. Light that others take is not deringed again, so it
  /// may be below 0 in some directions; clamp exit radiance.
  std::span<const LightCoefficients> light_of(int node) const;

  /// Tells what the last update did.
  const ShadowStatistics& statistics() const;

  /// Tells how far the balls of `exponentiation` are off the silhouettes of an asset (SphereSet); 0 for other methods.
  double sphere_mismatch(int asset) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
