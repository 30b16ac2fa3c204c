// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "bake/egl/receiver_tiles.h"
#include "gpu/gl_objects.h"
#include "sh/transfer_sums.h"

namespace kiln {

/// Sums that a shader keeps in registers, at most.
inline constexpr int most_register_sums = 36;

/// Returns `count`, rounded up to a multiple of four: shaders sum four at a time.
constexpr int in_fours(int count) { return (count + 3) / 4 * 4; }

/// Receivers that fit one storage buffer, on the GPU, and the totals of their sums.
struct ReceiverGroup {
  std::size_t first = 0;  ///< index of the first receiver
  std::size_t count = 0;
  std::vector<NormalCone> cones;      ///< by tile
  std::vector<std::uint32_t> facing;  ///< tiles that face a direction of the block, as `tiles` has them
  GlBuffer receivers;
  GlBuffer totals;  ///< `sums` planes of `count` 64-bit integers
  GlBuffer tiles;

  /// Uploads `count` receivers from `first` on, with `sums` totals each, all zero.
  ReceiverGroup(const Receivers& all, std::size_t first, std::size_t count, int sums);

  /// Finds the tiles that face one of the block's directions, and uploads them. Adds pairs of other tiles to `behind`.
  void face(std::span<const Eigen::Vector3f> directions, std::uint64_t& behind);

  /// Binds receivers, totals and tiles to the shader storage bindings 1, 3 and 4.
  void bind() const;

  /// Copies the totals to the group's receivers in `sums`.
  void read(TransferSums& sums) const;
};

/// Calls add(first, count) for groups of receivers, one after another, so small that no buffer of a group is too large
/// for a GPU: one has `sums` totals for each receiver, another `block_bytes`.
template <class Add>
void for_each_group(std::size_t receivers, int sums, std::size_t block_bytes, const Add& add) {
  constexpr std::size_t most_buffer_bytes = 96u << 20;  // llvmpipe has storage blocks of 128 MiB at most
  const std::size_t receiver_bytes = std::max(sizeof(std::uint64_t) * static_cast<std::size_t>(sums), block_bytes);
  const std::size_t most = most_buffer_bytes / receiver_bytes / tile_receivers * tile_receivers;
  for (std::size_t first = 0; first < receivers; first += most) add(first, std::min(most, receivers - first));
}

}  // namespace kiln
