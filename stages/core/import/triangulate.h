// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include "import/source_mesh.h"

namespace kiln {

/// Triangle cut from a face: the face, and three of its corners (indices of SourceMesh::corners).
struct CutTriangle {
  std::uint32_t face = 0;
  std::array<std::uint32_t, 3> corners{};
};

/// Cuts faces into triangles, in their order, each wound as its face. Quads are cut along the shorter of the diagonals
/// that keep both halves on the same side. Polygons of more corners are cut by triangulate_polygon, so that concave
/// ones are cut within themselves; where that fails, as a fan.
/// `polygons`, if given, counts the faces of more than three corners.
std::vector<CutTriangle> triangulate(const SourceMesh& source, int* polygons = nullptr);

/// Returns the box of the positions that triangles use.
Eigen::AlignedBox3d box_of(const SourceMesh& source, const std::vector<CutTriangle>& triangles);

}  // namespace kiln
