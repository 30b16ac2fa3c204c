// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Number of receivers of one workgroup.
inline constexpr std::size_t tile_receivers = 64;

/// Cone that holds the normals of tile_receivers receivers in a row. Only tiles that can have a positive cosine need be
/// looked at ([US 7,948,490], section 5).
struct NormalCone {
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  float sine = 1;  ///< sine of the half-angle; 1 where the normals spread over a hemisphere or more

  /// Returns whether every normal of the cone is at a right angle to `direction` or more.
  bool faces_away(const Eigen::Vector3f& direction) const { return axis.dot(direction) < -sine; }
};

/// Returns one cone for each tile of `normals`; the last tile may be smaller.
std::vector<NormalCone> normal_cones(std::span<const Eigen::Vector3f> normals);

/// Bounds of a tile as shaders/bake_tiles.glsl has it (std430).
struct TileBounds {
  Eigen::Vector4f sphere;  ///< centre and radius of a sphere that holds the receivers
  Eigen::Vector4f cone;    ///< NormalCone's axis and sine
};

/// Returns the bounds of each tile of `receivers`, whose normals have these cones.
std::vector<TileBounds> tile_bounds(const Receivers& receivers, std::span<const NormalCone> cones);

/// Returns the tiles that face at least one of `directions`, in order; adds the pairs of the other tiles' receivers and
/// the directions to `behind_pairs`.
std::vector<std::uint32_t> facing_tiles(std::span<const NormalCone> cones, std::size_t receivers,
                                        std::span<const Eigen::Vector3f> directions, std::uint64_t& behind_pairs);

}  // namespace kiln
