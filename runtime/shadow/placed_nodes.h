// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "mesh/placement.h"
#include "mesh/triangle_mesh.h"
#include "runtime/scene/scene_tree.h"

namespace kiln {

/// A ball around something; empty if the radius is negative.
struct BoundingBall {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double radius = -1;
};

/// Returns a ball around the vertices that triangles use, nearly the smallest ([Badoiu 2003]: steps to the farthest).
BoundingBall bounding_ball(const TriangleMesh& mesh);

/// Returns a ball around balls, those that are empty left out.
BoundingBall bounding_ball(std::span<const BoundingBall> balls);

/// Cone of directions, as seen from a point; a half-angle of pi is the whole sphere.
struct ViewCone {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();
  double half_angle = 0;  ///< radians
  double distance = 0;    ///< to the ball's centre
};

/// Returns the cone of a ball as seen from a point; the whole sphere from inside it.
ViewCone cone_of(const BoundingBall& ball, const Eigen::Vector3d& point);

/// A node at its place.
struct PlacedNode {
  BoundingBall ball;        ///< around the node, or all that hangs under it
  double silhouette = 0;    ///< radius of a disc of the mean area of the silhouette; of a composite node, of their sum
  bool has_static = false;  ///< whether it or a node under it is static
};

/// Places all nodes: `balls` and `silhouettes` (radii) are those of the assets in their own space.
std::vector<PlacedNode> place_nodes(const SceneTree& tree, std::span<const BoundingBall> balls,
                                    std::span<const double> silhouettes, const ScenePoses& poses);

/// Tests whether `node` is `other` or hangs under it.
bool is_under(const SceneTree& tree, int node, int other);

/// Returns the mesh nodes under `node`, itself included.
std::vector<int> meshes_under(const SceneTree& tree, int node);

/// Tests whether one node's shadow may fall on another: not on itself, and not where bakes hold it already.
inline bool may_shadow(const SceneTree& tree, int occluder, int receiver) {
  return occluder != receiver && !(tree.nodes[static_cast<std::size_t>(occluder)].is_static &&
                                   tree.nodes[static_cast<std::size_t>(receiver)].is_static);
}

}  // namespace kiln
