#include "bake/embree_engine.h"

#include <Eigen/Geometry>

#include "raycast/ray_scene.h"
#include "raycast/ray_transfer.h"

namespace kiln {

TransferVectors EmbreeEngine::compute(const TransferRequest& request, const ProgressFunction& progress) {
  Eigen::AlignedBox3f box;
  for (const Eigen::Vector3f& position : request.occluder_hull) box.extend(position);
  const RayScene scene(request.occluder_positions, request.occluder_triangles);
  return transfer_by_rays(scene, request.receivers, request.directions, request.bands,
                          static_cast<float>(ray_offset_) * box.diagonal().norm(), progress);
}

std::string EmbreeEngine::renderer() const { return ray_library_name(); }

}  // namespace kiln
