// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/rays/mixed_engine.h"

#include "base/progress.h"
#include "sh/basis.h"

namespace kiln {

MixedEngine::MixedEngine(const TransferScene& scene, float ray_offset, std::vector<Eigen::Vector3f> planned)
    : transfer_(scene.positions, scene.triangles, ray_offset), planned_(std::move(planned)) {}

void MixedEngine::set_receivers(const Receivers& receivers, int bands) {
  blocked_ = memory_ != nullptr ? BlockedRays(*memory_) : BlockedRays();
  transfer_.set_receivers(receivers, coefficient_count(bands), planned_);
  receivers_ = receivers.size();
}

void MixedEngine::add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) {
  const BeamSavings savings = transfer_.add(directions, progress, &blocked_);
  work_.pairs += static_cast<std::uint64_t>(receivers_) * directions.size();
  work_.single_rays += static_cast<std::uint64_t>(transfer_.split().rays.size()) * directions.size();
  work_.behind_tiles += savings.behind;
  work_.lit_tiles += savings.lit;
}

}  // namespace kiln
