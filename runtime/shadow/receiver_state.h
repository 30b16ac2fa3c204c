// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "runtime/shadow/combined_shadows.h"
#include "runtime/shadow/kept_state.h"

namespace kiln {

/// What a receiver's light was computed of by `combined`, occluder by occluder, so that what moves costs only the
/// points that may see it, and only rays at what moves.
class ReceiverState {
 public:
  /// What has changed since the light was computed.
  struct Change {
    bool is_all = false;              ///< the receiver itself or the lights: every point
    std::vector<BoundingBall> balls;  ///< around whatever has moved, where it was and where it is; the scene's space
  };

  /// Notes the occluders of a moment; `own` is the key of the receiver and the lights. Sorts the occluders by whether
  /// they stand still, and counts those.
  Change note(const ShadowStage& stage, int receiver, StateKey own, double unit, NodeOccluders& occluders);

  /// Makes room for the layers of so many points, each of `words`; none where that takes too much memory.
  void keep_layers(std::size_t points, std::size_t words);
  /// Returns the layer of a point. It may be written until the next note().
  PointLayer layer(std::size_t point, const NodeOccluders& occluders);

  /// Renames nodes: node_now[node], or -1 for one that is no more.
  void rename(std::span<const int> node_now);

 private:
  struct Seen {
    int node, sort;     ///< a node may be both shot at with rays and, for the sky, a cap
    StateKey key;       ///< its place relative to the receiver's
    BoundingBall ball;  ///< relative to the receiver's place
    bool in_layer;
  };
  static const Seen* find(const std::vector<Seen>& all, int node, int sort);
  static std::vector<Seen> seen_now(const ShadowStage& stage, const Placement& pose, double unit,
                                    const NodeOccluders& occluders);

  bool is_noted_ = false;
  StateKey own_;
  std::vector<Seen> seen_;  ///< by node and sort
  std::size_t words_ = 0;
  std::vector<std::uint64_t> bits_;      ///< point * words_ + word
  std::vector<std::uint32_t> versions_;  ///< by point: of the layer that its bits are; 0: none
  std::uint32_t version_ = 1, valid_version_ = 1;
};

}  // namespace kiln
