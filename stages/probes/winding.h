#pragma once

#include <Eigen/Core>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// How often the surface goes around `point`: the solid angles of all triangles over 4 pi, positive where they show
/// their back. 1 inside of a closed mesh whose triangles face outwards, 0 outside, in between near one with holes
/// (Jacobson, Kavan and Sorkine-Hornung, "Robust inside-outside segmentation using generalized winding numbers", 2013;
/// the angle by van Oosterom and Strackee 1983). Exact but for rounding; linear in triangles.
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3f& point);

}  // namespace kiln
