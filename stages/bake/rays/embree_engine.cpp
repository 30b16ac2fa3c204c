// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/rays/embree_engine.h"

#include "base/progress.h"
#include "raycast/ray_transfer.h"
#include "sh/basis.h"

namespace kiln {

EmbreeEngine::EmbreeEngine(const TransferScene& scene, float ray_offset)
    : scene_(scene.positions, scene.triangles), ray_offset_(ray_offset) {}

void EmbreeEngine::set_receivers(const Receivers& receivers, int bands) {
  receivers_ = receivers;
  sums_ = TransferSums(receivers.size(), coefficient_count(bands));
}

void EmbreeEngine::add(std::span<const Eigen::Vector3f> directions, const ProgressFunction& progress) {
  add_transfer_by_rays(scene_, receivers_, directions, ray_offset_, sums_, progress);
  work_.pairs += static_cast<std::uint64_t>(receivers_.size()) * directions.size();
  work_.single_rays = work_.pairs;
}

}  // namespace kiln
