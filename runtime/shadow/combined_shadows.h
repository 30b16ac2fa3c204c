// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "runtime/shadow/light_sources.h"
#include "runtime/shadow/placed_nodes.h"
#include "runtime/shadow/ray_occluder.h"
#include "runtime/shadow/visibility_engine.h"

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

/// How many of a list of occluders, its first ones, have stood still relative to the receiver since the last update,
/// and how many of these, again the first, are in the layers of its points (PointLayer) already.
struct StillCounts {
  std::size_t kept = 0, all = 0;
};

/// Nodes that may take light from a receiver.
struct NodeOccluders {
  std::vector<int> meshes;      ///< mesh nodes that rays are cast at
  std::vector<int> sky_meshes;  ///< those of them that the sky sees so
  std::vector<int> sky_caps;    ///< nodes, composite ones too, that are caps before the sky, nearest first
  StillCounts still_meshes, still_sky_meshes;
};

/// What those occluders block at a point that stand still: directions of each distant cone of light, then of the sky.
struct PointLayer {
  std::span<std::uint64_t> bits = {};  ///< layer_words() of them, or none: nothing is kept
  bool is_valid = false;               ///< whether they hold what the kept occluders block
};

/// Returns the number of words of a PointLayer.
std::size_t layer_words(const ShadowStage& stage, const LightSources& sources);

/// Finds the nodes that may stand between the receiver's ball and any of the lights. `cap` is the half-angle (radians)
/// below which a node is a cap before the sky. Descends the tree: what hangs under a node that cannot be in the way is
/// not looked at.
NodeOccluders find_occluders(const ShadowStage& stage, int receiver, const LightSources& sources, double cap);

/// Sine of the angle below the horizon from which light counts as none: texels near a vertex lean off its normal.
inline constexpr double far_below_horizon = -0.35;

/// A point that receives light, in the scene's space.
struct ShadowPoint {
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  std::optional<Eigen::Vector3d> normal;  ///< then cones and caps far below its horizon cost few rays, or none
};

/// Tests whether all of a ball is so far below the horizon that the node's own body hides it.
bool is_far_below(const ShadowPoint& point, const BoundingBall& ball);

/// Sees a cone of light from a point: what may stand before it, and whether its axis alone stands for it.
struct ConeView {
  Eigen::Vector3d position, axis;                            ///< of the point; unit vector towards the light
  double half_angle = 0;                                     ///< radians
  double longest = std::numeric_limits<double>::infinity();  ///< distance to the light where it is farthest

  /// Tests whether a ball may cover a part of the light.
  bool may_cover(const BoundingBall& ball) const;
};

/// Tests whether a cone of light is decided by its axis alone: a single direction, or one far below the horizon, which
/// the node's own body hides.
bool is_seen_by_axis(const ShadowPoint& point, const Eigen::Vector3d& axis, double half_angle);

/// Tests whether an occluder may stand between a receiver and a ball of light.
bool may_stand_between(const BoundingBall& receiver, const BoundingBall& occluder, const LightSpec& ball);

/// Tests whether anything within a ball may take light from a point, or almost may. Where not, the point need not be
/// looked at again when the ball moves.
bool may_see(const ShadowPoint& point, const BoundingBall& ball, const LightSources& sources);

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
///
/// One direction of the sky stands for its seven neighbours far below the point's horizon, and meshes that are wholly
/// there are not looked at.
///
/// `known` is what a VisibilityEngine found at the point; then no rays are cast but those of caps. `layer` is read, and
/// written where other occluders stand still now than it holds.
std::optional<LightSum> removed_light(const ShadowStage& stage, const NodeOccluders& occluders,
                                      const SceneLights& lights, const LightSources& sources, int bands,
                                      const ShadowPoint& point, const PointVisibility* known = nullptr,
                                      const PointLayer& layer = {});

}  // namespace kiln
