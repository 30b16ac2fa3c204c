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

/// Surface that receivers see: triangles whose front, the side from which they wind counter-clockwise, sends out
/// vectors, linear between the vectors of three points. The engine copies what it keeps, except the uncut surface,
/// which outlives it.
struct ReflectingSurface {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  std::span<const std::array<std::uint32_t, 3>> points;  ///< points at each triangle's corners
  /// The same surface before it was cut, as TransferScene has it: decides which rays are blocked.
  std::span<const Eigen::Vector3f> uncut_positions;
  std::span<const std::array<std::uint32_t, 3>> uncut_triangles;
  std::span<const Eigen::Vector3f> hull;  ///< as TransferScene has it
  bool closed = false;
};

/// Interface of what gathers bounced light: receivers, a surface that sends out vectors, directions in; sums of what is
/// received out. A TransferEngine integrates what receivers see of the sky, a GatherEngine what they see of the
/// surface.
class GatherEngine {
 public:
  virtual ~GatherEngine() = default;

  /// Sets what the surface's points send out: `width` numbers of at most 8 for each point. Copied.
  virtual void set_radiance(std::span<const float> values, int width) = 0;

  /// Returns, for each receiver and component, the sum over unit vectors s of max(0, n.s) times what the first surface
  /// point along s sends (nothing from its back): TransferSums with `width` coefficients, whose transfer() is the
  /// integral over pi. The same bits whatever the number of threads. Directions of a block of block_directions that lie
  /// close together go faster.
  virtual TransferSums gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                              const ProgressFunction& progress) = 0;

  /// Does what gather() does for receivers in packet_order, a part of those that `known` describes, which starts with a
  /// packet. Leaves in `known` what the next call with the same receivers and directions need not find again. Gives the
  /// same bits whatever is known or kept. Engines that cast no rays call gather().
  virtual TransferSums gather_known(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                    const KnownRays& /*known*/, const ProgressFunction& progress) {
    return gather(receivers, directions, progress);
  }

  /// Returns the largest number of receivers for one call, which bounds memory.
  virtual std::size_t most_receivers() const { return std::size_t{1} << 17; }  // 75 sums of 8 bytes each: 79 MB

  /// Returns the name of the GL renderer or of the ray library, for the record.
  virtual std::string renderer() const = 0;
};

}  // namespace kiln
