// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Returns the positions of a mesh's triangles that are corners of their convex hull, by x, then y, then z.
std::vector<Eigen::Vector3f> hull_corners(const TriangleMesh& mesh);

}  // namespace kiln
