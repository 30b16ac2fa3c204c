// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Cuts a polygon, whose corners need not lie in a plane, into triangles of its corners' numbers, with its winding: by
/// constrained Delaunay triangulation where it is nearly flat, else with the least dihedral angles and area [Liepa
/// 2003]. Returns nothing where CGAL finds no such triangles.
std::vector<Triangle> triangulate_polygon(const std::vector<Eigen::Vector3d>& corners);

}  // namespace kiln
