// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Computes what a collapse should cost, per vertex, so that triangles go where a small displacement shows: 1 on
/// surface of constant transfer, more where transfer varies from place to place. A texel that lies d from its place
/// shows transfer that is wrong by d times its gradient, and a collapse costs about d squared, so the weight grows with
/// the gradient's square: 1 + 4 times it over its mean, at most 100. Transfer of 4 bands, shadowed by the mesh itself,
/// its bands weighted as in the expected relighting error. `mesh` needs no normals; its unit of length does not matter.
std::vector<double> transfer_weights(const TriangleMesh& mesh);

}  // namespace kiln
