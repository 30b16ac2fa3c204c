// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>

#include "bake/engines/transfer_engine.h"
#include "base/progress.h"
#include "raycast/beam_transfer.h"

namespace kiln {

/// Engine that finds shadows by beams: the parallel rays of 16 neighbouring receivers take one search of the occluders'
/// tree for a whole block of directions, and one ray for all of them where only sheets of triangles stand before them.
/// Finds the exact visibility that EmbreeEngine finds, up to roundings of rays that pass an edge, in a fraction of the
/// time (docs/benchmarks.md): the fast way of a machine without a GPU. Related to conservative regions
/// ([US 7,948,490], section 5) and shaft culling [Haines 1991].
class BeamEngine : public TransferEngine {
 public:
  /// Rays start `ray_offset` (object units) off the receiver along its normal.
  BeamEngine(const TransferScene& scene, float ray_offset);

  void set_receivers(const Receivers& receivers, int bands) override;
  void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) override;
  void keep_blocked(RayMemory* memory) override { memory_ = memory; }
  BlockedRays take_blocked() override { return std::exchange(blocked_, {}); }
  TransferSums sums() override { return sums_; }
  TransferWork work() const override { return work_; }
  std::string renderer() const override { return "Kiln beams"; }
  bool is_software() const override { return true; }

 private:
  BeamScene scene_;
  float ray_offset_;
  BeamReceivers packets_;
  RayMemory* memory_ = nullptr;
  BlockedRays blocked_;
  TransferSums sums_;
  TransferWork work_;
};

}  // namespace kiln
