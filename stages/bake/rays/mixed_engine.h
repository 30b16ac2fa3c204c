// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <utility>
#include <vector>

#include "bake/engines/transfer_engine.h"
#include "base/progress.h"
#include "raycast/mixed_transfer.h"

namespace kiln {

/// Engine that finds shadows by beams where a pilot finds them cheaper than rays, by rays elsewhere: the default of a
/// machine without a GPU.
class MixedEngine : public TransferEngine {
 public:
  /// Rays start `ray_offset` (object units) off the receiver along its normal. `planned`: as many directions, in
  /// coherent blocks, as receivers are likely to get; the pilot casts some of them.
  MixedEngine(const TransferScene& scene, float ray_offset, std::vector<Eigen::Vector3f> planned);

  void set_receivers(const Receivers& receivers, int bands) override;
  void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) override;
  void keep_blocked(RayMemory* memory) override { memory_ = memory; }
  BlockedRays take_blocked() override { return std::exchange(blocked_, {}); }
  TransferSums sums() override { return transfer_.sums(); }
  TransferWork work() const override { return work_; }
  std::string renderer() const override { return "Kiln beams and " + ray_library_name(); }
  bool is_software() const override { return true; }

 private:
  MixedTransfer transfer_;
  std::vector<Eigen::Vector3f> planned_;
  std::size_t receivers_ = 0;
  RayMemory* memory_ = nullptr;
  BlockedRays blocked_;
  TransferWork work_;
};

}  // namespace kiln
