// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "bake/engines/transfer_work.h"
#include "base/progress.h"
#include "raycast/known_rays.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// Occluders of one bake. The engine copies what it keeps.
struct TransferScene {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  /// Points whose convex hull holds all occluders: the corners of their hull, or simply all positions.
  std::span<const Eigen::Vector3f> hull;
  /// Whether every edge has one triangle on either side, so that back faces need not be drawn.
  bool closed = false;
};

/// Interface of what integrates direct transfer: receivers, occluders, directions in; sums of transfer out. One engine
/// has one scene, reads and writes no files, and gives the same bits whatever the number of threads.
class TransferEngine {
 public:
  virtual ~TransferEngine() = default;

  /// Starts sums at zero for these receivers and `bands` of spherical harmonics; neighbours in the list should stand
  /// next to each other. The receivers' lists outlive their use.
  virtual void set_receivers(const Receivers& receivers, int bands) = 0;

  /// Adds unit vectors towards the light, block after block of block_directions. The same directions in the same blocks
  /// add the same bits whichever calls they come in. Directions of a block that lie close together go faster.
  virtual void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) = 0;

  /// Keeps blocked rays from the next set_receivers on, as far as `memory` has room, which outlives additions; null
  /// ends that. All calls of add() but the last then add whole blocks. Engines that cast no beams keep nothing.
  virtual void keep_blocked(RayMemory* /*memory*/) {}

  /// Gives away the blocked rays kept since set_receivers, whose packets are those of packet_order.
  virtual BlockedRays take_blocked() { return {}; }

  /// Returns the sums since set_receivers.
  virtual TransferSums sums() = 0;

  /// Returns the statistics of all calls of add().
  virtual TransferWork work() const = 0;

  /// Returns the name of the GL renderer or of the ray library, for the record.
  virtual std::string renderer() const = 0;

  /// Returns whether the engine runs on a CPU.
  virtual bool is_software() const = 0;
};

}  // namespace kiln
