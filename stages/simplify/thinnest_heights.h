// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Finds for each vertex the height below which its triangles are too thin, in a frame where the mesh's box has a
/// diagonal of 1; `diagonal` is that diagonal in object units. A component has what 16 bits can tell in its own box,
/// but not less than what 24 bits, the most that a file has, can in the mesh's.
std::vector<float> thinnest_heights(const TriangleMesh& mesh, double diagonal);

}  // namespace kiln
