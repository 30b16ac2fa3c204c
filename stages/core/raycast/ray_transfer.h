// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <span>

#include "base/progress.h"
#include "raycast/ray_scene.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// Adds the transfer over `directions` by occlusion rays. Visibility is exact for the triangles of `scene`; rays start
/// `ray_offset` (object units) off the receiver along its normal. Neighbouring receivers should stand next to each
/// other in the list: each block of them is cast as one stream per direction. Any number of threads gives the same
/// bits.
void add_transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                          std::span<const Eigen::Vector3f> directions, float ray_offset, TransferSums& sums,
                          const ProgressFunction& progress = no_progress);

/// Computes the transfer of `directions` alone, each standing for an equal share of the sphere.
TransferVectors transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                                 std::span<const Eigen::Vector3f> directions, int bands, float ray_offset,
                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
