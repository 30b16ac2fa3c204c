// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Returns a mesh of these vertices of another, in this order and with their attributes, without triangles.
TriangleMesh with_vertices(const TriangleMesh& mesh, std::span<const std::uint32_t> vertices);

/// Returns a mesh of these triangles, which name vertices of another mesh, and of the vertices that they use.
/// `sources`, if given, becomes the vertex of `mesh` that each vertex was.
TriangleMesh with_triangles(const TriangleMesh& mesh, std::span<const Triangle> triangles,
                            std::vector<std::uint32_t>* sources = nullptr);

}  // namespace kiln
