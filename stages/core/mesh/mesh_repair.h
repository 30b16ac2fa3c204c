// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <array>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

struct MeshRepairSettings {
  int fill_hole_edges = 0;         ///< largest number of edges of a hole that is closed; 0 leaves all open
  bool keeps_orientation = false;  ///< closed components that are inside out are left so
  bool keeps_backs = false;        ///< a triangle and its back are two sides of a sheet, not duplicates
};

/// Source of each triangle after repair: its triangle in the mesh before repair.
using TriangleOrigins = std::vector<std::uint32_t>;

/// Counts of the repairs that made a clean, oriented manifold of a mesh: all zero for one that was that already.
struct MeshRepairs {
  int merged_vertices = 0;        ///< at the very same place as another
  int welded_vertices = 0;        ///< on borders, moved to another within the file's last digits (weld_borders)
  int unused_vertices = 0;        ///< in no triangle
  int triangulated_polygons = 0;  ///< faces of more than three corners
  int degenerate_triangles = 0;   ///< with a vertex repeated, or corners on one line
  int duplicate_triangles = 0;    ///< same three vertices as another triangle, wound alike
  int dropped_backs = 0;          ///< same three vertices as another triangle, wound the other way
  int reversed_triangles = 0;     ///< wound against the majority (by area) of the surface that they continue
  int nonmanifold_edges = 0;      ///< edges of more than two triangles, where sheets were taken apart
  int nonmanifold_vertices = 0;   ///< where several fans met, ends of cut edges not counted
  int unorientable_edges = 0;     ///< cut, as a Moebius strip cannot be wound consistently
  int inside_out_components = 0;  ///< closed, of negative volume and inside no other: turned
  int clamped_colors = 0;         ///< vertex colours outside 0 to 1, clamped
  int filled_holes = 0;           ///< closed on request (MeshRepairSettings)

  // Findings that are not repaired.
  int components = 0;
  int border_loops = 0;  ///< holes and rims that are left

  /// Returns a name for each kind of repair, as results use it.
  static const std::array<std::pair<const char*, int MeshRepairs::*>, 14>& kinds();

  /// Tells whether the mesh was clean; filled holes do not count.
  bool is_clean() const;

  /// Writes the counts, such as "3 merged vertices, 1 degenerate triangles".
  std::string text() const;
};

/// Makes an oriented manifold, possibly with border, of `mesh`: positions, triangles and colors; normals and uvs are
/// cleared. Merges vertices at the same position; drops duplicate triangles; removes triangles without area such that
/// their neighbours still meet; winds neighbours alike (majority of the area); takes sheets apart where more than two
/// triangles meet in an edge or several fans in a vertex, keeping the two that continue each other best together; and
/// turns closed components that are inside out. A clean mesh keeps its vertices and triangles in their order. The
/// result may have no triangles at all. `origins`, if given, receives the source of each triangle; those that close a
/// hole get a neighbour's.
MeshRepairs repair_mesh(TriangleMesh& mesh, const MeshRepairSettings& settings = {},
                        TriangleOrigins* origins = nullptr);

/// Tells whether the triangles are an oriented manifold, possibly with border: each directed edge once, one fan per
/// vertex.
bool is_manifold(const TriangleMesh& mesh);

}  // namespace kiln
