// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "runtime/shadow/light_sources.h"
#include "runtime/shadow/placed_nodes.h"
#include "runtime/shadow/ray_occluder.h"

namespace kiln {

/// A scene of one moment, as the methods see it.
struct ShadowStage {
  const SceneTree& tree;
  const ScenePoses& poses;
  std::span<const PlacedNode> placed;   ///< by node
  std::span<const RayOccluder> meshes;  ///< by asset
  const DirectionSet& sky;

  const RayOccluder& mesh_of(int node) const {
    return meshes[static_cast<std::size_t>(tree.nodes[static_cast<std::size_t>(node)].asset)];
  }
  const PlacedNode& place_of(int node) const { return placed[static_cast<std::size_t>(node)]; }
  const Placement& pose_of(int node) const { return poses[static_cast<std::size_t>(node)]; }
};

/// Nodes that may take light from a receiver.
struct NodeOccluders {
  std::vector<int> meshes;      ///< mesh nodes that rays are cast at
  std::vector<int> sky_meshes;  ///< those of them that the sky sees so
  std::vector<int> sky_caps;    ///< nodes, composite ones too, that are caps before the sky, nearest first
};

/// Finds the nodes that may stand between the receiver's ball and any of the lights. `cap` is the half-angle (radians)
/// below which a node is a cap before the sky. Descends the tree: what hangs under a node that cannot be in the way is
/// not looked at.
NodeOccluders find_occluders(const ShadowStage& stage, int receiver, const LightSources& sources, double cap);

/// A point that receives light, in the scene's space.
struct ShadowPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> normal;  ///< then cones and caps far below its horizon cost few rays, or none
};

/// Computes what the occluders take from the light at a point: the projection of L (1 - V), each light under its own
/// window, where V is 0 in directions that any occluder blocks. Three channels, the scene's space; empty if nothing is
/// taken.
///
/// L is the light itself, not its harmonics, so no triple product cuts it or V to a few bands. Single directions are
/// one ray each; cones and balls are sampled by directions of their own, skies by those of the stage. Sums over
/// directions differ from the closed forms that the lights are projected with, by their closings; the blocked share of
/// that is taken too, so that what is wholly blocked goes to zero. Only directions within the bounding cones of
/// occluders cost rays, and those at a light of finite distance end at it.
///
/// A cap stands for a node that covers little sky: a disc of the mean area of its silhouette at its centre, with the
/// zonal coefficients of that closed form. Seven directions of it say what share is not taken already by meshes and
/// caps before it.
std::optional<LightSum> removed_light(const ShadowStage& stage, const NodeOccluders& occluders,
                                      const SceneLights& lights, const LightSources& sources, int bands,
                                      const ShadowPoint& point);

}  // namespace kiln
