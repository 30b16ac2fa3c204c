// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/rays/ray_gather_engine.h"

#include <numeric>

#include "base/progress.h"
#include "raycast/gather.h"

namespace kiln {

RayGatherEngine::RayGatherEngine(const ReflectingSurface& surface, float ray_offset, bool by_beams)
    : scene_(surface.positions, surface.triangles),
      by_beams_(by_beams),
      uncut_positions_(surface.uncut_positions),
      uncut_triangles_(surface.uncut_triangles),
      ray_offset_(ray_offset),
      points_(surface.points.begin(), surface.points.end()) {}

void RayGatherEngine::set_radiance(std::span<const float> values, int width) {
  values_.assign(values.begin(), values.end());
  width_ = width;
}

TransferSums RayGatherEngine::gather(const BeamReceivers& receivers, std::span<const Eigen::Vector3f> directions,
                                     const KnownRays& known, const ProgressFunction& progress) {
  const std::size_t blocks = (directions.size() + block_directions - 1) / block_directions;
  const bool knows_all = known.blocked != nullptr && known.blocked->holds(blocks);
  if (by_beams_ && !knows_all && !beams_) beams_.emplace(uncut_positions_, uncut_triangles_);
  TransferSums sums(receivers.order.size(), width_);
  add_gathered(scene_, beams_ ? &*beams_ : nullptr, receivers, directions,
               {points_, values_, static_cast<std::size_t>(width_)}, sums, progress, known);
  return sums;
}

TransferSums RayGatherEngine::gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                     const ProgressFunction& progress) {
  return gather(BeamReceivers(receivers, ray_offset_), directions, {}, progress);
}

TransferSums RayGatherEngine::gather_known(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                           const KnownRays& known, const ProgressFunction& progress) {
  std::vector<std::uint32_t> order(receivers.size());
  std::iota(order.begin(), order.end(), 0u);
  return gather(BeamReceivers(receivers, ray_offset_, std::move(order)), directions, known, progress);
}

std::string RayGatherEngine::renderer() const {
  return by_beams_ ? "Kiln beams, " + ray_library_name() : ray_library_name();
}

}  // namespace kiln
