// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "raycast/beam_kernels.h"

namespace kiln {

/// How many bytes may be kept of rays. Any thread may take of them; what is taken does not come back.
class RayMemory {
 public:
  explicit RayMemory(std::size_t bytes) : left_(bytes) {}

  /// False, and nothing is taken, where fewer are left.
  bool take(std::size_t bytes);
  std::size_t left() const { return left_; }

 private:
  std::atomic<std::size_t> left_;
};

/// Lanes of a packet for each direction of a block, a bit for each of 16 receivers.
using BlockLanes = std::array<std::uint16_t, beam_directions>;

/// Which rays of packets of receivers are blocked, a bit for each pair of a receiver and a direction: what a direct
/// pass finds, kept for passes over the same rays after it. Blocks of directions are kept one after the other, of all
/// packets each, until memory is at its end.
class BlockedRays {
 public:
  /// Keeps nothing.
  BlockedRays() = default;
  /// Keeps what `memory` has room for, which must outlive additions. The first block added is `first_block` of all.
  explicit BlockedRays(RayMemory& memory) : memory_(&memory) {}

  /// What adds blocks counts them from 0; they are those from `first` on.
  void start_at(std::size_t first) { first_block_ = first; }

  /// Room for the next block, packet after packet; null where it is not kept, and no later one either.
  BlockLanes* add_block(std::size_t packets);

  /// The lanes of a packet that face a direction of the block, but do not see it; bits of lanes that face away, in
  /// directions that others face, are set as well. Null where this is not kept.
  const BlockLanes* find(std::size_t packet, std::size_t block) const {
    const std::size_t own = block - first_block_;  // huge for one before the first
    return own < blocks_.size() ? &blocks_[own][packet] : nullptr;
  }

  /// Whether all of so many blocks are kept.
  bool holds(std::size_t blocks) const { return first_block_ == 0 && blocks_.size() >= blocks; }

 private:
  RayMemory* memory_ = nullptr;
  std::size_t first_block_ = 0;
  std::vector<std::vector<BlockLanes>> blocks_;
};

/// What the rays of packets of receivers hit first, of those that hit a front: what the first pass over them finds,
/// kept for later ones.
class FirstHits {
 public:
  struct Hit {
    std::uint32_t triangle;
    float u, v;  ///< as in SurfacePoint
  };
  /// Parallel rays that hit something: as many hits as `lanes` has bits, from the lowest on.
  struct Rays {
    std::uint32_t direction;
    std::uint32_t lanes;
  };
  /// Hits of one packet, directions ascending.
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
  /// Keeps what `memory` has room for, which must outlive additions; a packet's place is paid for when it is kept.
  FirstHits(RayMemory& memory, std::size_t packets);

  bool keeps() const { return memory_ != nullptr; }

  /// The packet's, null where they are not kept.
  const Packet* find(std::size_t packet) const {
    return packet < packets_.size() && packets_[packet].known ? &packets_[packet] : nullptr;
  }

  /// Keeps a packet's hits, all directions, if there is room. Threads may call it at once for packets of their own.
  void keep(std::size_t packet, const Packet& found);

 private:
  RayMemory* memory_ = nullptr;
  std::vector<Packet> packets_;
};

/// What is known of the rays of receivers of which one pass takes a part at a time.
struct KnownRays {
  const BlockedRays* blocked = nullptr;
  FirstHits* hits = nullptr;     ///< taken where they are kept, else found and kept
  std::size_t first_packet = 0;  ///< of the part, in both
};

/// Receivers of a list, as packets of 16 take them, and what is known of their rays over a list of directions.
struct TracedReceivers {
  std::vector<std::uint32_t> order;  ///< packet p, lane i is receiver order[16 p + i]; the last packet may lack some
  BlockedRays blocked;
  FirstHits hits;

  std::size_t packets() const { return (order.size() + beam_lanes - 1) / beam_lanes; }
};

}  // namespace kiln
