// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raycast/beam_kernels.h"

namespace kiln {

/// Number of bytes that may still be spent on known rays. Any thread may take some; they are never given back.
class RayMemory {
 public:
  explicit RayMemory(std::size_t bytes) : left_(bytes) {}

  /// Takes bytes; false, taking nothing, if too few are left.
  bool take(std::size_t bytes);
  std::size_t left() const { return left_; }

 private:
  std::atomic<std::size_t> left_;
};

/// Lanes of a packet for each direction of a block: one bit per receiver.
using BlockLanes = std::array<std::uint16_t, beam_directions>;

/// Rays of packets of receivers that are blocked, a bit for each pair of a receiver and a direction: found by a direct
/// pass, kept for later passes over the same rays. Blocks of directions are kept in order, each for all packets, until
/// the memory is used up.
class BlockedRays {
 public:
  /// Keeps nothing.
  BlockedRays() = default;
  /// Keeps what `memory`, which must outlive all additions, has room for. The first block added is number
  /// `first_block`.
  explicit BlockedRays(RayMemory& memory) : memory_(&memory) {}

  /// Sets the number of the first block: callers that add blocks count them from 0, and mean those from `first` on.
  void start_at(std::size_t first) { first_block_ = first; }

  /// Makes room for the next block, packet after packet; null if neither it nor later blocks are kept.
  BlockLanes* add_block(std::size_t packets);

  /// Returns the blocked lanes of a packet in a block: those that face a direction but do not see it. Bits of lanes
  /// that face away are also set, in directions that others face. Null if not kept.
  const BlockLanes* find(std::size_t packet, std::size_t block) const {
    const std::size_t own = block - first_block_;  // wraps to a huge number for a block before the first
    return own < blocks_.size() ? &blocks_[own][packet] : nullptr;
  }

  /// Tests whether all of the first `blocks` blocks are kept.
  bool holds(std::size_t blocks) const { return first_block_ == 0 && blocks_.size() >= blocks; }

 private:
  RayMemory* memory_ = nullptr;
  std::size_t first_block_ = 0;
  std::vector<std::vector<BlockLanes>> blocks_;
};

/// First hits of rays of packets of receivers, for rays that hit a front face: found by the first pass over them, kept
/// for later ones.
class FirstHits {
 public:
  struct Hit {
    std::uint32_t triangle;
    float u, v;  ///< as in SurfacePoint
  };
  /// Parallel rays that hit something: as many hits as `lanes` has bits, from the lowest bit on.
  struct Rays {
    std::uint32_t direction;
    std::uint32_t lanes;
  };
  /// Hits of one packet, in ascending order of directions.
  struct Packet {
    std::vector<Rays> rays;
    std::vector<Hit> hits;
    bool known = false;

    void clear();
    void append(const Packet& other);
    std::size_t bytes() const { return rays.size() * sizeof(Rays) + hits.size() * sizeof(Hit); }
  };

  /// Keeps nothing.
  FirstHits() = default;
  /// Keeps what `memory` has room for; it must outlive additions. Memory is taken when a packet is kept.
  FirstHits(RayMemory& memory, std::size_t packets);

  bool keeps() const { return memory_ != nullptr; }

  /// Returns a packet's hits; null if they are not kept.
  const Packet* find(std::size_t packet) const {
    return packet < packets_.size() && packets_[packet].known ? &packets_[packet] : nullptr;
  }

  /// Keeps a packet's hits over all directions, if there is room. Threads may call this at once for different packets.
  void keep(std::size_t packet, const Packet& found);

 private:
  RayMemory* memory_ = nullptr;
  std::vector<Packet> packets_;
};

/// Knowledge of the rays of a part of the receivers, of which one pass takes a part at a time.
struct KnownRays {
  const BlockedRays* blocked = nullptr;
  FirstHits* hits = nullptr;     ///< read if kept for the packet, else found and kept
  std::size_t first_packet = 0;  ///< first packet of the part, in both
};

/// A list of receivers in packets of 16, and what is known of their rays over a list of directions.
struct TracedReceivers {
  std::vector<std::uint32_t> order;  ///< packet p, lane i is receiver order[16 p + i]; the last packet may be shorter
  BlockedRays blocked;
  FirstHits hits;

  std::size_t packets() const { return (order.size() + beam_lanes - 1) / beam_lanes; }
};

}  // namespace kiln
