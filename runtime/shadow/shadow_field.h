// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <vector>

#include "runtime/shadow/placed_nodes.h"
#include "runtime/shadow/ray_occluder.h"

namespace kiln {

/// Visibility past an object at points of shells around it, in spherical harmonics, computed once and looked up [Zhou
/// 2005]. Object space.
class ShadowField {
 public:
  /// Computes 16 shells from the object's bounding ball to 8 times that, each of 16 x 32 points by latitude and
  /// azimuth; 1,024 directions around each point. `silhouette` is the radius of the disc that stands for it beyond the
  /// shells.
  ShadowField(const RayOccluder& mesh, const BoundingBall& ball, double silhouette, int bands);

  /// Returns the visibility around a point, in the object's space: interpolated between eight points of two shells;
  /// within the innermost shell that of the shell, beyond the outermost that of a cap.
  std::vector<float> visibility(const Eigen::Vector3d& point) const;

 private:
  static constexpr int shells = 16, latitudes = 16, azimuths = 32;
  const float* at(int shell, int latitude, int azimuth) const {
    return values_.data() +
           static_cast<std::size_t>(((shell * latitudes + latitude) * azimuths + azimuth) * coefficients_);
  }

  BoundingBall ball_;
  double silhouette_;
  int bands_, coefficients_;
  std::vector<float> values_;
};

}  // namespace kiln
