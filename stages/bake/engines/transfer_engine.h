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

/// What casts shadows. The engine copies what it keeps.
struct TransferScene {
  std::span<const Eigen::Vector3f> positions;
  std::span<const std::array<std::uint32_t, 3>> triangles;
  /// Points whose convex hull holds all occluders: the corners of their hull, or simply all positions.
  std::span<const Eigen::Vector3f> hull;
  /// Whether every edge has one triangle on either side, so that back faces need not be drawn.
  bool closed = false;
};

/// How many pairs of a receiver and a direction were decided how. What is in none of the skipped kinds was tested.
struct TransferWork {
  std::uint64_t pairs = 0;           ///< all of them
  std::uint64_t behind_tiles = 0;    ///< skipped: the whole tile of receivers faces away (normal cone)
  std::uint64_t lit_tiles = 0;       ///< not tested: nothing stands before the whole tile
  std::uint64_t shadowed_tiles = 0;  ///< not tested: all of the tile lies behind something
  std::uint64_t ambiguous = 0;       ///< depth tests within the map's error band
  std::uint64_t refined = 0;         ///< of these, decided by rays

  TransferWork operator-(const TransferWork& earlier) const {
    return {pairs - earlier.pairs,         behind_tiles - earlier.behind_tiles,
            lit_tiles - earlier.lit_tiles, shadowed_tiles - earlier.shadowed_tiles,
            ambiguous - earlier.ambiguous, refined - earlier.refined};
  }
};

/// Receivers, occluders, directions in; sums of transfer out. One engine has one scene.
class TransferEngine {
 public:
  virtual ~TransferEngine() = default;

  /// From now on these receivers, whose sums start at zero; neighbours should stand next to each other. They must
  /// outlive their use. `bands` of spherical harmonics.
  virtual void set_receivers(const Receivers& receivers, int bands) = 0;

  /// Adds unit vectors towards the light, block after block of block_directions. The same directions in the same blocks
  /// add the same bits whichever calls they come in. Directions of a block that lie close together go faster.
  virtual void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) = 0;

  /// From the next set_receivers on, rays found to be blocked are kept as far as `memory` has room, which must outlive
  /// additions; null: no longer. All calls of add() but the last then add whole blocks. Engines that do not cast beams
  /// keep nothing.
  virtual void keep_blocked(RayMemory* /*memory*/) {}

  /// Gives away what was kept since set_receivers, whose packets are those of packet_order.
  virtual BlockedRays take_blocked() { return {}; }

  /// What was added since set_receivers.
  virtual TransferSums sums() = 0;

  /// Of all calls of add().
  virtual TransferWork work() const = 0;

  /// What did the work, for the record: the GL renderer's name, or the ray library's.
  virtual std::string renderer() const = 0;

  /// Whether a CPU did it.
  virtual bool is_software() const = 0;
};

}  // namespace kiln
