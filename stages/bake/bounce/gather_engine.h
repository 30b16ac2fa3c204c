// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "base/progress.h"
#include "raycast/known_rays.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// What receivers see: triangles whose front, the side from which they wind counter-clockwise, sends out vectors,
/// linear between those of three points. The engine copies what it keeps, but for the surface before it was cut, which
/// outlives it.
struct ReflectingSurface {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const std::array<std::uint32_t, 3>> points;  ///< of each triangle's corners
  /// The same surface before it was cut, as TransferScene has it: by this, what is blocked is decided.
  std::span<const Eigen::Vector3f> uncut_positions;
  std::span<const std::array<std::uint32_t, 3>> uncut_triangles;
  std::span<const Eigen::Vector3f> hull;  ///< as TransferScene has it
  bool closed = false;
};

/// Receivers, a surface that sends out vectors, directions in; sums of what is received out. Stands beside
/// TransferEngine: the one has what receivers see of the sky, the other what they see of the surface.
class GatherEngine {
 public:
  virtual ~GatherEngine() = default;

  /// What the surface's points send out from now on: point after point, `width` numbers of at most 8 each. Copied.
  virtual void set_radiance(std::span<const float> values, int width) = 0;

  /// The sums over unit vectors s, for each receiver, of max(0, n.s) times what the surface's first point along s sends
  /// (nothing from its back), component after component: TransferSums with `width` coefficients, whose transfer() is
  /// the integral over pi. The same bits whatever the number of threads. Directions of a block of block_directions that
  /// lie close together go faster.
  virtual TransferSums gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                              const ProgressFunction& progress) = 0;

  /// gather() of receivers in packet_order, a part of those that `known` tells of, so that it starts with a packet.
  /// Leaves there what the next call with the same receivers and directions need not find again. Gives the same bits
  /// whatever is known, or kept. For engines that cast no rays, this is gather().
  virtual TransferSums gather_known(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                    const KnownRays& /*known*/, const ProgressFunction& progress) {
    return gather(receivers, directions, progress);
  }

  /// How many receivers one call should have at most: as many as the engine works well with, to bound memory.
  virtual std::size_t most_receivers() const { return std::size_t{1} << 17; }  // 75 sums of 8 bytes each: 79 MB

  /// What did the work, for the record.
  virtual std::string renderer() const = 0;
};

}  // namespace kiln
