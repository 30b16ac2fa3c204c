// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "bake/engines/gather_engine.h"
#include "base/progress.h"
#include "raycast/beam_scene.h"
#include "raycast/beam_transfer.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// Engine that gathers at first hits by Embree, in packets of 16 parallel rays. With `by_beams`, Kiln's beams find
/// which rays hit anything, and Embree finds what those hit.
class RayGatherEngine : public GatherEngine {
 public:
  /// Rays start `ray_offset` (object units) off the receiver along its normal. Beams search the uncut surface, as those
  /// of the direct pass do; their tree is built when first needed.
  RayGatherEngine(const ReflectingSurface& surface, float ray_offset, bool by_beams);

  void set_radiance(std::span<const float> values, int width) override;
  TransferSums gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                      const ProgressFunction& progress) override;
  TransferSums gather_known(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                            const KnownRays& known, const ProgressFunction& progress) override;
  std::size_t most_receivers() const override { return std::size_t{1} << 14; }
  std::string renderer() const override;

 private:
  TransferSums gather(const BeamReceivers& receivers, std::span<const Eigen::Vector3f> directions,
                      const KnownRays& known, const ProgressFunction& progress);

  RayScene scene_;
  bool by_beams_;
  std::span<const Eigen::Vector3f> uncut_positions_;
  std::span<const std::array<std::uint32_t, 3>> uncut_triangles_;
  std::optional<BeamScene> beams_;
  float ray_offset_;
  std::vector<std::array<std::uint32_t, 3>> points_;
  std::vector<float> values_;
  int width_ = 0;
};

}  // namespace kiln
