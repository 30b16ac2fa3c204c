// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <vector>

#include "collapse/texture_deviation.h"
#include "collapse/wedge_mesh.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Distances of samples from where their uvs show, in units of the mesh.
struct SampleDeviation {
  double largest = 0;
  double rms = 0;  ///< over the first mesh's surface
};

/// Measures samples against a surface whose wedges lie at `positions`.
SampleDeviation deviation_of(std::span<const PlacedSample> samples, const std::vector<Eigen::Vector3f>& positions);

/// What a collapse has left, fitted. Both lists are by wedge.
struct FittedLevel {
  std::vector<Eigen::Vector3f> positions;
  std::vector<Eigen::Vector3f> normals;  ///< empty where the first mesh has none
  SampleDeviation deviation;
};

/// Moves the points that a collapse of `first` has left such that every uv shows the place it was made for as nearly as
/// its triangles can, by least squares that weigh large distances more; uvs stay. Normals are fitted likewise, one for
/// each point and side of a hard edge. Points stay where a triangle would turn or shrink too much, and all move less
/// where a sample would otherwise be farther than `largest` (0: no limit).
FittedLevel fit_to_samples(const WedgeMesh& wedges, const TriangleMesh& first, std::span<const PlacedSample> samples,
                           double largest);

}  // namespace kiln
