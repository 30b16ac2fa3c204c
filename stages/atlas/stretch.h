// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>

#include "atlas/chart.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Texture stretch ([Sander 2001], section 3): how much longer the surface is than its uvs, as root mean square over
/// the surface and all directions, and at its worst. Normalised by the total areas, so that 1 is best.
struct Stretch {
  double l2 = 1;
  double linf = 1;
};

/// Sums the stretch of triangles.
class StretchSum {
 public:
  /// Adds a triangle by the largest and the smallest singular value of the map from uv to the surface; an empty or
  /// flipped uv triangle has an infinite one.
  void add(const std::array<Eigen::Vector3d, 3>& corners, const std::array<Eigen::Vector2d, 3>& uvs);
  Stretch result() const;

 private:
  double area_ = 0, uv_area_ = 0, square_sum_ = 0, largest_ = 0;
};

/// Measures one chart.
Stretch measure_stretch(const Surface& surface, const Chart& chart);

/// Measures a whole atlas; triangles without area or without uv area do not count.
Stretch measure_stretch(const TriangleMesh& atlas);

}  // namespace kiln
