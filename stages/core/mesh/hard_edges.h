// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "mesh/triangle_edges.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Hard edges: edges across which a surface is not shaded smoothly, each once, in order. Only edges of two triangles
/// are listed; borders need not be.
using HardEdges = std::vector<EdgeKey>;

/// Finds the edges of an oriented manifold whose dihedral angle (0 in a plane) exceeds `degrees`.
HardEdges hard_edges_by_angle(const TriangleMesh& mesh, double degrees);

/// Finds the edges at either end of which the corner normals of both triangles lie more than `degrees` apart. None
/// where the mesh has no corner normals.
HardEdges hard_edges_of_normals(const TriangleMesh& mesh, double degrees = 2);

/// Finds the edges between triangles of different groups. Group 0 means no group: all edges of such triangles are hard.
HardEdges hard_edges_of_groups(const TriangleMesh& mesh, const std::vector<std::uint32_t>& group_of_triangle);

/// Computes normals as compute_vertex_normals does, but averages at each vertex only over triangles that are connected
/// across edges that are not hard. Without hard edges the mesh gets no corner normals.
void compute_normals_between(TriangleMesh& mesh, const HardEdges& hard_edges);

/// Sets `normals` to the means of the corner normals, weighted by the angle at the vertex. Drops the corner normals
/// where all of them lie within `degrees` of these means.
void average_corner_normals(TriangleMesh& mesh, double degrees = 0.5);

/// Splits vertices such that each has one normal: corner normals of a vertex within `degrees` of each other stay one.
/// `sources`, if given, becomes the vertex of `mesh` that each vertex was. A mesh without corner normals is returned
/// unchanged.
TriangleMesh split_at_hard_edges(const TriangleMesh& mesh, std::vector<std::uint32_t>* sources = nullptr,
                                 double degrees = 0.1);

}  // namespace kiln
