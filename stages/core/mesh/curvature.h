// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Computes the mean curvature (k1 + k2) / 2 at every vertex of an oriented mesh, one over its units of length:
/// positive where the surface is convex, 1 / r on a ball, 1 / (2 r) on a tube. It is half the component of the mean
/// curvature normal, by cotangents, along the normal of the faces about the vertex ([Meyer 2003], equation 8); on a
/// ball that is exact for any triangles. A hard edge counts with what it turns, spread over its triangles.
///
/// Numerator and area are averaged over neighbours again and again until that reaches about `radius`, in units of
/// length, so that noise of triangles smaller than that is left out; 0 for no averaging. Vertices without area get 0.
std::vector<float> mean_curvature(const TriangleMesh& mesh, double radius = 0);

}  // namespace kiln
