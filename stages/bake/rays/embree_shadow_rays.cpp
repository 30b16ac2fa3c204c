// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/rays/embree_shadow_rays.h"

#include <algorithm>
#include <limits>
#include <memory>

#include "base/parallel.h"
#include "raycast/ray_scene.h"

namespace kiln {

namespace {

class LazyScene {
 public:
  explicit LazyScene(const TransferScene& scene) : scene_(scene) {}

  const RayScene& rays() {
    if (!rays_) rays_ = std::make_unique<RayScene>(scene_.positions, scene_.triangles);
    return *rays_;
  }

 private:
  TransferScene scene_;
  std::unique_ptr<RayScene> rays_;
};

}  // namespace

ShadowRays make_shadow_rays(const TransferScene& scene, float ray_offset) {
  const auto lazy = std::make_shared<LazyScene>(scene);
  ShadowRays rays;
  rays.triangles_below = [lazy](const Receivers& receivers) {
    const RayScene& tree = lazy->rays();
    std::vector<std::uint32_t> triangles(receivers.size());
    parallel_for(std::size_t{0}, receivers.size(), [&](std::size_t r) {
      triangles[r] = tree.closest_point(receivers.positions[r], std::numeric_limits<float>::max()).triangle;
    });
    return triangles;
  };
  rays.occluded = [lazy, ray_offset](const Receivers& receivers, std::span<ShadowRayQuery> queries) {
    const RayScene& tree = lazy->rays();
    parallel_for(std::size_t{0}, queries.size(), [&](std::size_t q) {
      ShadowRayQuery& query = queries[q];
      std::vector<Eigen::Vector3f> origins;
      origins.reserve(query.receivers.size());
      for (std::uint32_t r : query.receivers)
        origins.emplace_back(receivers.positions[r] + ray_offset * receivers.normals[r]);
      tree.occluded(origins, query.direction, 0.f, query.occluded);
    });
  };
  return rays;
}

}  // namespace kiln
