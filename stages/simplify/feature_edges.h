// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Edge of a mesh by its two vertices.
using VertexPair = std::pair<std::uint32_t, std::uint32_t>;

/// Lines of the input that simplification keeps.
struct FeatureLines {
  std::vector<VertexPair> hard;    ///< that are shaded as edges
  std::vector<VertexPair> smooth;  ///< that are not, as borders of materials
};

/// Finds the edges that simplification keeps as lines: those of the border, those whose dihedral angle (0 in a plane)
/// exceeds `crease_degrees` (0: no edge does), and those of `given` that are edges of the mesh. Each once, the smaller
/// vertex first, sorted. `mesh` is an oriented manifold.
std::vector<VertexPair> find_feature_edges(const TriangleMesh& mesh, double crease_degrees,
                                           std::span<const VertexPair> given = {});

}  // namespace kiln
