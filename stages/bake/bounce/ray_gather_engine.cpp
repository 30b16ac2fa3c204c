#include "bake/bounce/ray_gather_engine.h"

#include "bake/engines/transfer_engine.h"
#include "raycast/gather.h"

namespace kiln {

RayGatherEngine::RayGatherEngine(const ReflectingSurface& surface, float ray_offset, bool by_beams)
    : scene_(surface.positions, surface.triangles),
      ray_offset_(ray_offset),
      points_(surface.points.begin(), surface.points.end()) {
  if (by_beams) beams_.emplace(surface.positions, surface.triangles);
}

void RayGatherEngine::set_radiance(std::span<const float> values, int width) {
  values_.assign(values.begin(), values.end());
  width_ = width;
}

TransferSums RayGatherEngine::gather(const Receivers& receivers, std::span<const Eigen::Vector3f> directions,
                                     const ProgressFunction& progress) {
  TransferSums sums(receivers.size(), width_);
  add_gathered(scene_, beams_ ? &*beams_ : nullptr, BeamReceivers(receivers, ray_offset_), directions,
               {points_, values_, static_cast<std::size_t>(width_)}, sums, progress);
  return sums;
}

std::string RayGatherEngine::renderer() const {
  return beams_ ? "Kiln beams, " + ray_library_name() : ray_library_name();
}

}  // namespace kiln
