// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace kiln {

/// Lanes of all vectors of the beam tracer: receivers of a packet, triangles of a cluster, children of a node.
inline constexpr int beam_lanes = 16;

/// 16 boxes of triangles, axis after axis, each with a cone that holds the triangles' normals (by winding).
struct alignas(64) BeamBoxes {
  float lower[3][beam_lanes];
  float upper[3][beam_lanes];
  float cone_axis[3][beam_lanes];
  float cone_sine[beam_lanes];  ///< of the half-angle; 2 where the normals spread over a hemisphere or more
  /// Sine of a cone about the same axis that also holds the normals of the triangles across the outline; 2 where these
  /// spread over a hemisphere or more, where the surface ends, and where more than two triangles meet at an edge.
  float sheet_sine[beam_lanes];
};

/// Triangles sorted into clusters of up to 16 neighbours under a tree of boxes, 16 to a node: what
/// beam_tracer.h casts beams at.
struct BeamScene {
  /// corner[k][axis][i] is corner k of triangle i. Only the first `count` mean anything.
  struct alignas(64) Cluster {
    float corner[3][3][beam_lanes];
    int count;
  };
  struct Node {
    BeamBoxes boxes;
    int count;                        ///< of children
    std::uint32_t is_cluster;         ///< bit i: child i is a cluster, not a node
    std::uint32_t child[beam_lanes];  ///< its index
  };

  static constexpr std::uint32_t no_node = 0xffffffff;

  std::vector<Node> nodes;
  std::vector<Cluster> clusters;
  std::uint32_t root = no_node;  ///< node above all triangles; no_node for no triangles
  /// Node above the lids: triangles that close the surface. Edges with ends at the same places being one, each edge of
  /// triangles and lids together is run through as often one way as the other. no_node where the triangles alone are
  /// so.
  std::uint32_t lids = no_node;
  /// A few roundings of the largest coordinate: the slack that makes all tests on boxes and planes conservative.
  float slack = 0;
  /// Hits nearer than this (object units) are looked at again by is_before.
  float doubtful = 0;

  BeamScene() = default;
  BeamScene(std::span<const Eigen::Vector3f> positions, std::span<const std::array<std::uint32_t, 3>> triangles);
};

}  // namespace kiln
