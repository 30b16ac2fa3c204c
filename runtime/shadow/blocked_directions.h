// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "mesh/placement.h"
#include "runtime/shadow/direction_set.h"
#include "runtime/shadow/occluder_outline.h"
#include "runtime/shadow/placed_nodes.h"
#include "runtime/shadow/ray_occluder.h"

namespace kiln {

/// Which directions of a set are blocked at a point; its memory serves for the next point, too.
///
/// Most directions are decided without rays: those outside the cone of the occluder's ball, or past its boxes, are
/// free, and those through a flat part of its surface are blocked (occluder_outline.h), blocks of neighbours at once
/// where they can be. What is blocked does not depend on the order of the occluders.
class BlockedDirections {
 public:
  /// Begins with all directions of the set free, or with those of `bits` blocked (store()). Of directions whose sine
  /// above the horizon of `normal` is below `far_below`, which the node's own body hides, one of each eight neighbours
  /// stands for the others.
  void reset(const DirectionSet& set, const std::optional<Eigen::Vector3d>& normal, float far_below,
             std::span<const std::uint64_t> bits = {});

  /// Blocks directions by a mesh within `ball` (scene's space), up to the distance `farthest` (by direction; empty: to
  /// infinity).
  void block(const RayOccluder& mesh, const Placement& placement, const BoundingBall& ball,
             const Eigen::Vector3d& position, std::span<const float> farthest);

  /// Writes down what is blocked, a bit for each direction in words(set) words.
  void store(std::span<std::uint64_t> bits) const;
  static std::size_t words(const DirectionSet& set) { return (set.x.size() + 63) / 64; }

  /// Lets directions follow those that stand for them, and returns how many are blocked.
  std::uint32_t finish();
  /// Returns 1 for a blocked direction, 0 for a free one, after finish().
  std::span<const std::uint8_t> blocked() const { return blocked_; }

 private:
  struct ViewedCone {
    Eigen::Vector3f axis;
    float cosine, sine;  ///< of the half-angle
    bool is_all_around;
  };
  /// Blocks those of a block's directions that need no ray, and adds those that do to tested_.
  void look_at_block(std::size_t block, const ViewedCone& cone, bool has_flats);

  const DirectionSet* set_ = nullptr;
  std::vector<std::uint8_t> blocked_;
  std::vector<std::uint32_t> followers_;  ///< directions that another one stands for: direction, leader, and so on
  std::vector<std::uint32_t> tested_;     ///< the first tested_count_ of them
  std::size_t tested_count_ = 0;
  OutlineView view_;
};

}  // namespace kiln
