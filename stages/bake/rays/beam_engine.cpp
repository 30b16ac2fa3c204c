// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/rays/beam_engine.h"

#include "base/progress.h"
#include "sh/basis.h"

namespace kiln {

BeamEngine::BeamEngine(const TransferScene& scene, float ray_offset)
    : scene_(scene.positions, scene.triangles), ray_offset_(ray_offset) {}

void BeamEngine::set_receivers(const Receivers& receivers, int bands) {
  blocked_ = memory_ != nullptr ? BlockedRays(*memory_) : BlockedRays();
  packets_ = BeamReceivers(receivers, ray_offset_);
  sums_ = TransferSums(receivers.size(), coefficient_count(bands));
}

void BeamEngine::add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) {
  const BeamSavings savings = add_transfer_by_beams(scene_, packets_, directions, sums_, progress, &blocked_);
  work_.pairs += static_cast<std::uint64_t>(sums_.receivers) * directions.size();
  work_.behind_tiles += savings.behind;
  work_.lit_tiles += savings.lit;
}

}  // namespace kiln
