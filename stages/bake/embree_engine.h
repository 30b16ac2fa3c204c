#pragma once

#include "bake/transfer_engine.h"

namespace kiln {

/// Shadows by occlusion rays (Embree): exact visibility of the occluders' triangles. The reference, and the CPU's way.
class EmbreeEngine : public TransferEngine {
 public:
  /// Rays start `ray_offset` off the receiver along its normal, a fraction of the occluders' bounding box diagonal.
  explicit EmbreeEngine(double ray_offset) : ray_offset_(ray_offset) {}

  TransferVectors compute(const TransferRequest& request, const ProgressFunction& progress) override;
  std::string renderer() const override;
  bool is_software() const override { return true; }

 private:
  double ray_offset_;
};

}  // namespace kiln
