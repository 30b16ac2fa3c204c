// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>

#include "bake/engines/shadow_rays.h"
#include "bake/engines/transfer_engine.h"

namespace kiln {

/// Weights of some receivers and a block of directions, as the shading pass leaves them.
struct BlockWeights {
  std::span<float> weights;  ///< cosine times visibility, direction after direction; the sign bit marks ambiguous ones
  std::size_t first = 0;     ///< receiver of the first weight of a direction
  std::size_t count = 0;     ///< number of receivers
  std::span<const std::uint32_t> tiles;  ///< tiles with weights, tile_receivers receivers each
};

/// Removes the marks, and counts them in `work`. With `refine`, `rays` decides the marked pairs: visibility becomes 0
/// or 1. The result does not depend on their order. Returns whether anything was marked.
bool resolve_ambiguous(const BlockWeights& block, const Receivers& receivers,
                       std::span<const Eigen::Vector3f> directions, bool refine, const ShadowRays& rays,
                       TransferWork& work);

}  // namespace kiln
