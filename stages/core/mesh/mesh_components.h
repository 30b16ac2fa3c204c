// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Parts of a mesh that share no vertex, numbered in the order of their first triangles.
struct Components {
  std::size_t count = 0;
  std::vector<std::uint32_t> of_triangle;
};

Components find_components(const TriangleMesh& mesh);

/// Returns the box of each component.
std::vector<BoundingBox> component_boxes(const TriangleMesh& mesh, const Components& components);

/// Finds the components that run along each edge as often in one direction as in the other, so that they bound a solid.
/// Returns 1 for each of them, 0 for the others.
std::vector<std::uint8_t> closed_components(const TriangleMesh& mesh, const Components& components);

/// Turns closed components of negative volume that lie inside no other closed component: the wall of a cavity faces
/// inwards rightly. `mesh` is an oriented manifold. Returns the number turned, and sets the number of components.
int turn_inside_out_components(TriangleMesh& mesh, int& components);

}  // namespace kiln
