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

/// Light that a surface sends out: vectors at its points, interpolated linearly over its triangles.
struct SurfaceRadiance {
  std::span<const std::array<std::uint32_t, 3>> points;  ///< for each triangle, the points of its three corners
  std::span<const float> values;                         ///< point after point, `width` numbers each
  std::size_t width = 0;
};

/// Gathers radiance at receivers: adds to sums.plane(i), for each receiver, the sum over directions s of max(0, n.s)
/// times component i of the radiance of the first surface point along s. Back faces send nothing. `radiance` belongs to
/// the triangles of `scene`; sums.coefficients is its width. `beams`, of the same surface, speeds this up: only rays
/// that beams find blocked are then cast at the scene (results differ for rays that pass an edge where the two
/// disagree). What is `known` of the rays is not searched again: which rays are blocked, as beams over the same surface
/// found, or first hits, as an earlier call left them; if either is complete, `beams` are not needed. Any number of
/// threads gives the same bits. Sums of a block of directions must stay below 2^8: radiance of at most 8.
void add_gathered(const RayScene& scene, const BeamScene* beams, const BeamReceivers& receivers,
                  std::span<const Eigen::Vector3f> directions, const SurfaceRadiance& radiance, TransferSums& sums,
                  const ProgressFunction& progress = no_progress, const KnownRays& known = {});

}  // namespace kiln
