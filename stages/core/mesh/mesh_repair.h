#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

struct MeshRepairSettings {
  int fill_hole_edges = 0;         ///< holes of at most so many edges are closed; 0 leaves all open
  bool keeps_orientation = false;  ///< closed components that are inside out stay so
  bool keeps_backs = false;        ///< a triangle and its back are two sides of a sheet, not duplicates
};

/// The triangle of a mesh before repair that each triangle after it comes from:
using TriangleOrigins = std::vector<std::uint32_t>;

/// What it took to make a clean, oriented manifold of a mesh: all zero for one that was that already.
struct MeshRepairs {
  int merged_vertices = 0;        ///< at the very same place as another
  int welded_vertices = 0;        ///< on borders, moved to another within the file's last digits (weld_borders)
  int unused_vertices = 0;        ///< in no triangle
  int triangulated_polygons = 0;  ///< faces of more than three corners
  int degenerate_triangles = 0;   ///< with a vertex repeated, or corners on one line
  int duplicate_triangles = 0;    ///< of the same three vertices as another, wound alike
  int dropped_backs = 0;          ///< of the same three vertices as another, wound the other way
  int reversed_triangles = 0;     ///< wound against the greater part of the surface that they continue
  int nonmanifold_edges = 0;      ///< of more than two triangles: sheets taken apart there
  int nonmanifold_vertices = 0;   ///< where several fans met, not counting the ends of edges that were cut
  int unorientable_edges = 0;     ///< cut, as a Moebius strip cannot be wound consistently
  int inside_out_components = 0;  ///< closed, of negative volume and inside no other: turned
  int clamped_colors = 0;         ///< of vertices, outside 0 to 1: clamped to that
  int filled_holes = 0;           ///< closed because MeshRepairSettings asks for it

  // Found, not mended.
  int components = 0;
  int border_loops = 0;  ///< that are left: holes and rims

  /// A name for each kind of repair, as results call it.
  static const std::array<std::pair<const char*, int MeshRepairs::*>, 14>& kinds();

  /// Whether the mesh was clean; filled holes are no fault of it.
  bool none() const;

  /// "3 merged vertices, 1 degenerate triangles".
  std::string text() const;
};

/// Makes an oriented manifold, possibly with border, of `mesh`: positions, triangles and colors; normals and uvs are
/// cleared. Merges vertices at the same place, drops duplicate triangles, removes those without area such that their
/// neighbours still meet, winds neighbours alike (majority of the area), takes sheets apart where more than two meet in
/// an edge or several fans in a vertex, and turns closed components that are inside out. Where three or more triangles
/// meet in an edge, the two that continue each other best stay together. What is clean already keeps its vertices and
/// triangles, in their order. The mesh may end with no triangle at all. `origins`, if given, tells where triangles come
/// from; those that close a hole come from a neighbour.
MeshRepairs repair_mesh(TriangleMesh& mesh, const MeshRepairSettings& settings = {},
                        TriangleOrigins* origins = nullptr);

/// Whether the triangles are an oriented manifold, possibly with border: each directed edge once, one fan a vertex.
bool is_manifold(const TriangleMesh& mesh);

}  // namespace kiln
