// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include "bake/engines/transfer_engine.h"
#include "base/progress.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// Engine that finds shadows by occlusion rays (Embree): exact visibility of the occluders' triangles. The reference.
class EmbreeEngine : public TransferEngine {
 public:
  /// Rays start `ray_offset` (object units) off the receiver along its normal.
  EmbreeEngine(const TransferScene& scene, float ray_offset);

  void set_receivers(const Receivers& receivers, int bands) override;
  void add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) override;
  TransferSums sums() override { return sums_; }
  TransferWork work() const override { return work_; }
  std::string renderer() const override { return ray_library_name(); }
  bool is_software() const override { return true; }

 private:
  RayScene scene_;
  float ray_offset_;
  Receivers receivers_;
  TransferSums sums_;
  TransferWork work_;
};

}  // namespace kiln
