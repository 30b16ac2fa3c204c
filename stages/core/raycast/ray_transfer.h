#pragma once

#include <Eigen/Core>
#include <span>

#include "base/progress.h"
#include "raycast/ray_scene.h"
#include "sh/transfer.h"

namespace kiln {

/// The transfer integral by occlusion rays: t_i = 4/N * sum over the directions of B_i(s) V(s) max(0, n.s), which is
/// 1/pi times the integral over the sphere when the N `directions` are spread evenly. Visibility is exact for the
/// triangles of `scene`; rays start `ray_offset` (object units) off the receiver along its normal. Neighbouring
/// receivers should stand next to each other: each block of them is cast as one stream per direction. Any number of
/// threads gives the same bytes.
TransferVectors transfer_by_rays(const RayScene& scene, const Receivers& receivers,
                                 std::span<const Eigen::Vector3f> directions, int bands, float ray_offset,
                                 const ProgressFunction& progress = no_progress);

}  // namespace kiln
