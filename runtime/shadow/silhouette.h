// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "runtime/shadow/placed_nodes.h"
#include "runtime/shadow/ray_occluder.h"

namespace kiln {

/// Parallel rays from many sides through the ball around a mesh, evenly over its disc, and which of them meet the mesh;
/// object space.
struct SilhouetteRays {
  struct Ray {
    Eigen::Vector3d origin, direction;  ///< starts outside the ball
  };
  std::vector<Ray> rays;
  std::vector<std::uint8_t> meets;
};

/// Casts 32 x 128 rays.
SilhouetteRays cast_silhouettes(const RayOccluder& mesh, const BoundingBall& ball);

/// Returns the radius of a disc of the mean area of the silhouette.
double silhouette_radius(const SilhouetteRays& rays, const BoundingBall& ball);

}  // namespace kiln
