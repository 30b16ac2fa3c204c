#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// An edge of a mesh by its vertices, the lesser first.
using EdgeKey = std::pair<std::uint32_t, std::uint32_t>;

/// Edges across which a surface is not shaded smoothly, each once, in order. Only edges of two triangles are hard: a
/// border needs no word.
using HardEdges = std::vector<EdgeKey>;

/// The edges of an oriented manifold whose dihedral angle (0 in a plane) exceeds `degrees`.
HardEdges hard_edges_by_angle(const TriangleMesh& mesh, double degrees);

/// The edges at either end of which the corner normals of both triangles lie more than `degrees` apart. None where the
/// mesh has no corner normals.
HardEdges hard_edges_of_normals(const TriangleMesh& mesh, double degrees = 2);

/// The edges between triangles of different groups, and between those of no group (0) and any other.
HardEdges hard_edges_of_groups(const TriangleMesh& mesh, const std::vector<std::uint32_t>& group_of_triangle);

/// Sets the normals of a mesh as compute_vertex_normals does, but at each vertex only over the triangles that hang
/// together across edges that are not hard. Without hard edges there are no corner normals then.
void compute_normals_between(TriangleMesh& mesh, const HardEdges& hard_edges);

/// Sets `normals` to the means of the corner normals, weighted by the angle at the vertex. Drops the corner normals
/// where they lie within `degrees` of these everywhere.
void average_corner_normals(TriangleMesh& mesh, double degrees = 0.5);

/// A mesh whose vertices are split such that each has one normal: corner normals of a vertex within `degrees` of each
/// other stay one. `sources`, if given, becomes the vertex of `mesh` that each vertex was. A mesh without corner
/// normals is returned as it is.
TriangleMesh split_at_hard_edges(const TriangleMesh& mesh, std::vector<std::uint32_t>* sources = nullptr,
                                 double degrees = 0.1);

/// A mesh whose vertices at the very same place are one; the triangles keep their order. Normals and what else vertices
/// have is left out.
TriangleMesh join_at_places(const TriangleMesh& mesh);

}  // namespace kiln
