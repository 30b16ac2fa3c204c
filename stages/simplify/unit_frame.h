// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Frame in which a mesh's bounding box is centred on the origin with a diagonal of 1. Collapses are computed in it:
/// quadrics of far away or tiny objects lose their digits otherwise, and tolerances get a meaning.
struct UnitFrame {
  Eigen::Vector3d centre;  ///< of the box, in object units
  double diagonal;         ///< of the box, in object units

  explicit UnitFrame(const TriangleMesh& mesh);
  Eigen::Vector3d to_object(const Eigen::Vector3d& p) const { return centre + diagonal * p; }
  Eigen::Vector3d from_object(const Eigen::Vector3f& p) const { return (p.cast<double>() - centre) / diagonal; }
};

}  // namespace kiln
