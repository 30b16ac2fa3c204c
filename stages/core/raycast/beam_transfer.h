// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>
#include <vector>

#include "base/progress.h"
#include "raycast/beam_scene.h"
#include "raycast/beam_tracer.h"
#include "raycast/known_rays.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// Orders receivers so that packets of 16 stand near each other and have similar normals. Depends on the receivers
/// only.
std::vector<std::uint32_t> packet_order(const Receivers& receivers);

/// Receivers in packets of 16 that stand near each other and have similar normals, whatever order they come in.
struct BeamReceivers {
  std::vector<BeamPacket> packets;
  std::vector<std::uint32_t> order;  ///< packet p, lane i is receiver order[16 p + i]; the last packet may be shorter

  BeamReceivers() = default;
  /// Groups receivers into packets. Rays start `ray_offset` (object units) off the receiver along its normal.
  BeamReceivers(const Receivers& receivers, float ray_offset);
  /// Groups receivers whose packet_order is known.
  BeamReceivers(const Receivers& receivers, float ray_offset, std::vector<std::uint32_t> in_packets);
};

/// Statistics over (receiver, direction) pairs for which no triangle was tested.
struct BeamSavings {
  std::uint64_t behind = 0;  ///< pairs of packets that face away as a whole
  std::uint64_t lit = 0;     ///< pairs of packets with nothing in their way
};

/// Adds the transfer over `directions`, with visibility exact for the triangles of `scene`. Any number of threads and
/// any width of vectors give the same bits; a receiver that comes in another packet may differ by a ray that passes an
/// edge. Blocks of directions that lie close together are faster (order_coherently). With `blocked`, rays found to be
/// blocked are kept there; then all calls but the last must add whole blocks.
BeamSavings add_transfer_by_beams(const BeamScene& scene, const BeamReceivers& receivers,
                                  std::span<const Eigen::Vector3f> directions, TransferSums& sums,
                                  const ProgressFunction& progress = no_progress, BlockedRays* blocked = nullptr);

}  // namespace kiln
