// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "sh/transfer.h"

namespace kiln {

/// Receivers of one workgroup.
inline constexpr std::size_t tile_receivers = 64;

/// The cone that holds the normals of tile_receivers receivers that follow each other (the patent's section 5: only
/// regions that can have a positive cosine need be looked at).
struct NormalCone {
  Eigen::Vector3f axis = Eigen::Vector3f::Zero();
  float sine = 1;  ///< of the half-angle; 1 where the normals spread over a hemisphere or more

  /// Whether every normal of the cone is at a right angle to `direction` or more.
  bool faces_away(const Eigen::Vector3f& direction) const { return axis.dot(direction) < -sine; }
};

/// One cone for each tile of `normals`, the last tile perhaps a smaller one.
std::vector<NormalCone> normal_cones(std::span<const Eigen::Vector3f> normals);

/// A tile as shaders/bake_tiles.glsl has it (std430).
struct TileBounds {
  Eigen::Vector4f sphere;  ///< centre and radius of a sphere that holds the receivers
  Eigen::Vector4f cone;    ///< NormalCone's axis and sine
};

/// The bounds of each tile of `receivers`, whose normals have these cones.
std::vector<TileBounds> tile_bounds(const Receivers& receivers, std::span<const NormalCone> cones);

/// The tiles that at least one of `directions` does not see from behind, in order; `behind_pairs` grows by the number
/// of pairs of the others' receivers and directions.
std::vector<std::uint32_t> facing_tiles(std::span<const NormalCone> cones, std::size_t receivers,
                                        std::span<const Eigen::Vector3f> directions, std::uint64_t& behind_pairs);

}  // namespace kiln
