// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// Half-edge collapse that is topologically possible: point `from` becomes point `to`, a neighbour of it. Corners at
/// `from` become wedges of `to`: on either side of a seam the one that lies on that side.
struct WedgeCollapse {
  /// Triangles between two seams, or all of them, and what becomes of their corners at `from`.
  struct Sector {
    std::vector<std::uint32_t> triangles;  ///< about `from`, those on the edge included
    std::uint32_t from_wedge = 0;
    std::uint32_t to_wedge = 0;
    /// The outline on this side runs from `before` to from_wedge to `after`, with the sector to its left; one of both
    /// is to_wedge. Meaningless where `from` does not lie on a line.
    std::uint32_t before = 0, after = 0;
  };

  std::uint32_t from = 0, to = 0;
  bool on_line = false;  ///< along a seam, a hard edge or the mesh's border
  std::vector<Sector> sectors;
};

/// Mesh with an atlas under collapse. Its vertices, split at seams of uvs and at hard edges, are wedges; wedges of one
/// place on the surface are one point. Points and wedges keep their numbers, positions and uvs, so every mesh on the
/// way has a subset of the first one's vertices.
class WedgeMesh {
 public:
  /// Takes an oriented mesh with uvs. Sides of an edge are joined where they have the same vertices or, at seams, the
  /// same positions; where more than two sides are left, its points stay.
  explicit WedgeMesh(const TriangleMesh& mesh);

  std::size_t wedge_count() const { return point_of_.size(); }
  std::size_t point_count() const { return triangles_of_.size(); }
  int triangle_count() const { return triangle_count_; }

  bool is_there(std::uint32_t triangle) const { return there_[triangle] != 0; }
  const Triangle& wedges(std::uint32_t triangle) const { return wedges_[triangle]; }
  std::uint32_t point_of(std::uint32_t wedge) const { return point_of_[wedge]; }
  const std::vector<std::uint32_t>& triangles_of(std::uint32_t point) const { return triangles_of_[point]; }

  /// Returns the corner (0 to 2) of a triangle that is at a point of it.
  std::size_t corner_at(std::uint32_t triangle, std::uint32_t point) const;

  /// Lists the points that a point has edges to.
  std::vector<std::uint32_t> neighbours(std::uint32_t point) const;

  /// Lists the collapses of a point that keep the surface a manifold, seams and borders where they lie, and their
  /// junctions. None for a point that is gone, or stays.
  std::vector<WedgeCollapse> collapses_of(std::uint32_t point) const;

  void apply(const WedgeCollapse& collapse);

  /// Lists sides of triangles that lie on the outline of a chart or on a hard edge, as pairs of wedges along the
  /// triangle.
  std::vector<std::array<std::uint32_t, 2>> outline() const;

  /// Lists the triangles that are left, by wedges, in their first order.
  std::vector<Triangle> triangles() const;

 private:
  struct Spoke;
  std::vector<Spoke> spokes_about(std::uint32_t point, bool& closed) const;
  bool keeps_manifold(std::uint32_t from, std::uint32_t to, std::size_t triangles_on_edge) const;

  std::vector<Triangle> wedges_;                          ///< by triangle
  std::vector<std::uint8_t> there_;                       ///< by triangle
  std::vector<std::uint32_t> point_of_;                   ///< by wedge
  std::vector<std::vector<std::uint32_t>> triangles_of_;  ///< by point
  std::vector<std::uint8_t> stays_;                       ///< by point
  int triangle_count_ = 0;
};

}  // namespace kiln
