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

/// Receivers in an order whose packets of 16 stand near each other and face about the same way. The same for the same
/// receivers.
std::vector<std::uint32_t> packet_order(const Receivers& receivers);

/// Receivers in packets of 16 that stand near each other and face about the same way, whatever order they come in.
struct BeamReceivers {
  std::vector<BeamPacket> packets;
  std::vector<std::uint32_t> order;  ///< packet p, lane i is receiver order[16 p + i]; the last packet may lack some

  BeamReceivers() = default;
  /// Rays start `ray_offset` (object units) off the receiver along its normal.
  BeamReceivers(const Receivers& receivers, float ray_offset);
  /// Packets of receivers whose packet_order is known.
  BeamReceivers(const Receivers& receivers, float ray_offset, std::vector<std::uint32_t> in_packets);
};

/// Pairs of a receiver and a direction of which no triangle was tested.
struct BeamSavings {
  std::uint64_t behind = 0;  ///< the whole packet faces away
  std::uint64_t lit = 0;     ///< nothing stands before the whole packet
};

/// Adds the transfer over `directions`, visibility exact for the triangles of `scene`. Any number of threads and any
/// width of vectors give the same bits; receivers in other packets may differ by a ray that passes an edge. Blocks of
/// directions that lie close together go faster (order_coherently). With `blocked`, rays found to be blocked are kept
/// there; all calls but the last then add whole blocks.
BeamSavings add_transfer_by_beams(const BeamScene& scene, const BeamReceivers& receivers,
                                  std::span<const Eigen::Vector3f> directions, TransferSums& sums,
                                  const ProgressFunction& progress = no_progress, BlockedRays* blocked = nullptr);

}  // namespace kiln
