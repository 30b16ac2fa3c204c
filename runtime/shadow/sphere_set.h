// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "runtime/shadow/silhouette.h"

namespace kiln {

/// Balls that stand for a mesh; object space.
struct SphereSet {
  std::vector<BoundingBall> balls;
  double mismatch = 0;  ///< rays that meet the mesh or the balls, not both, over those that meet the mesh
};

/// Fits at most `count` balls to a mesh. Points of its surface and of its inside (winding number above a half) are
/// clustered [Lloyd 1982]; each cluster's bounding ball is shrunk by the factor, the same for all, under which the
/// silhouettes of mesh and balls differ least. The number is `count`, a half, a quarter and so on, whichever differs
/// least: a ball is one ball.
SphereSet fit_spheres(const TriangleMesh& mesh, const SilhouetteRays& silhouettes, int count);

/// Returns the logarithm of the visibility past balls as seen from `point`, in `bands` bands: the sum of those of each,
/// as if none overlapped [Ren 2006].
std::vector<float> log_visibility(std::span<const BoundingBall> balls, const Eigen::Vector3d& point, int bands);

}  // namespace kiln
