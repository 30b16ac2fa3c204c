// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <span>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Returns the winding number of the surface around `point`: the solid angles of all triangles over 4 pi, positive
/// where their back is seen. 1 inside a closed mesh whose triangles face outwards, 0 outside, in between near one with
/// holes ([Jacobson 2013]; solid angles by [Oosterom 1983]). Exact except for rounding; linear in triangles.
double winding_number(const TriangleMesh& mesh, const Eigen::Vector3d& point);

/// Returns the winding number of some of the mesh's triangles.
double winding_number(const TriangleMesh& mesh, std::span<const std::uint32_t> triangles, const Eigen::Vector3d& point);

}  // namespace kiln
