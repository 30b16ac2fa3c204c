// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <span>

#include "mesh/placement.h"
#include "mesh/triangle_mesh.h"
#include "runtime/shadow/direction_set.h"
#include "runtime/shadow/occluder_outline.h"

namespace kiln {

/// What is nearer to a point than this share of the radius of its own bounding ball touches the point, to the rounding
/// of float32, and blocks nothing there.
inline constexpr double touching_share = 1e-6;

/// A mesh as rays see it, in Embree's hierarchy; each object of a scene has one, wherever its nodes stand. Queries may
/// be made from many threads at once.
class RayOccluder {
 public:
  /// Builds the hierarchy, by one thread, and keeps no reference to the mesh. Throws MachineLacks if there is no
  /// device.
  explicit RayOccluder(const TriangleMesh& mesh);
  ~RayOccluder();
  RayOccluder(RayOccluder&&) noexcept;
  RayOccluder& operator=(RayOccluder&&) noexcept;

  /// Returns what spares rays: boxes around the mesh, and flat parts of it.
  const OccluderOutline& outline() const;

  /// Casts rays from `origin` along the directions `which` of a set, up to the distance `farthest` (by index in the
  /// set; empty: to infinity), and sets blocked[d] of each that meets the mesh as placed. All in the scene's space.
  void block(const Placement& placement, const Eigen::Vector3d& origin, const DirectionSet& set,
             std::span<const std::uint32_t> which, std::span<const float> farthest,
             std::span<std::uint8_t> blocked) const;

  /// Tests a single ray in the same way.
  bool blocks(const Placement& placement, const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
              float farthest) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln
