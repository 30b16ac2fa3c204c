// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "base/progress.h"
#include "raycast/beam_transfer.h"
#include "raycast/known_rays.h"
#include "raycast/ray_scene.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// What a surface sends out: vectors at points of it, linear over its triangles in between.
struct SurfaceRadiance {
  std::span<const std::array<std::uint32_t, 3>> points;  ///< of each triangle, the points of its three corners
  std::span<const float> values;                         ///< point after point, `width` numbers each
  std::size_t width = 0;
};

/// Adds to sums.plane(i), for each receiver, the sum over directions s of max(0, n.s) times component i of what the
/// surface sends out at the first point that the receiver sees along s. A back face sends nothing. `radiance` is of the
/// triangles of `scene`; sums.coefficients is its width. With `beams`, the same surface, only rays that beams find
/// blocked are cast at the scene, which is faster, but for rays that pass an edge where the two do not agree. What is
/// `known` of the rays is not searched again: neither which are blocked, that beams over the same surface found, nor
/// first hits, that an earlier call left there; with all of either, `beams` are not needed. Any number of threads gives
/// the same bits. Sums of a block of directions must stay below 2^8: radiance of at most 8.
void add_gathered(const RayScene& scene, const BeamScene* beams, const BeamReceivers& receivers,
                  std::span<const Eigen::Vector3f> directions, const SurfaceRadiance& radiance, TransferSums& sums,
                  const ProgressFunction& progress = no_progress, const KnownRays& known = {});

}  // namespace kiln
