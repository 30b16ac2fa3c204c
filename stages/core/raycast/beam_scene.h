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

/// Boxes of 16 sets of triangles, axis after axis, each with a cone that holds the triangles' normals (by winding).
struct alignas(64) BeamBoxes {
  float lower[3][beam_lanes];
  float upper[3][beam_lanes];
  float cone_axis[3][beam_lanes];
  float cone_sine[beam_lanes];  ///< sine of the half-angle; 2 if the normals spread over a hemisphere or more
  /// Sines of cones about the same axes that also hold the normals of the triangles across each set's outline; 2 if
  /// these spread over a hemisphere or more, if the surface ends there, or if more than two triangles meet at an edge.
  float sheet_sine[beam_lanes];
};

/// Triangles in clusters of up to 16 neighbours, under a tree of boxes with 16 children per node: the scene that
/// beam_tracer.h casts beams at.
struct BeamScene {
  /// Up to 16 triangles: corner[k][axis][i] is corner k of triangle i. Only the first `count` are valid.
  struct alignas(64) Cluster {
    float corner[3][3][beam_lanes];
    int count;
  };
  struct Node {
    BeamBoxes boxes;
    int count;                        ///< number of children
    std::uint32_t is_cluster;         ///< bit i: child i is a cluster, not a node
    std::uint32_t child[beam_lanes];  ///< index of the cluster or node
  };

  static constexpr std::uint32_t no_node = 0xffffffff;

  std::vector<Node> nodes;
  std::vector<Cluster> clusters;
  std::uint32_t root = no_node;  ///< root of the tree of all triangles; no_node if there are none
  /// Root of the tree of the lids, triangles that close the surface: with edges of equal end positions taken as one,
  /// triangles and lids together use each edge as often in one direction as in the other. no_node if the triangles
  /// alone do so.
  std::uint32_t lids = no_node;
  /// Margin of tests of boxes and planes, which makes them conservative: a few roundings of the largest coordinate.
  float slack = 0;
  /// Distance (object units) below which is_before decides hits.
  float doubtful = 0;

  BeamScene() = default;
  BeamScene(std::span<const Eigen::Vector3f> positions, std::span<const std::array<std::uint32_t, 3>> triangles);
};

}  // namespace kiln
