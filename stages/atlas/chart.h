// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "atlas/surface.h"

namespace kiln {

/// Method that a chart's flattening started from; all are relaxed afterwards (relax.h).
enum class Parameteriser { unfolded, lscm, arap, mean_value };

/// Topological disk of the surface and its place in the plane, in object units.
struct Chart {
  std::vector<std::uint32_t> faces;     ///< faces of the mesh
  std::vector<Triangle> triangles;      ///< parallel to `faces`, corners as in the mesh, into `vertices`
  std::vector<std::uint32_t> vertices;  ///< vertices of the mesh; at a slit, one may appear twice
  std::vector<Eigen::Vector2d> uvs;     ///< per vertex; area as on the surface once scaled by equalise_area
  Parameteriser parameteriser = Parameteriser::unfolded;
};

/// Returns twice the signed area of a triangle.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// Edge with a triangle on one side only, between two vertices of the chart; the chart lies on its left.
struct BorderEdge {
  std::uint32_t from, to;
};

/// Returns the border's edges, in no particular order.
std::vector<BorderEdge> border_edges(const Chart& chart);

/// Tells whether no triangle is flipped or empty and every uv is finite.
bool is_flip_free(const Chart& chart);

/// Tells whether the border is a simple polygon. A chart without flipped triangles then does not overlap itself [Lipman
/// 2014].
bool has_simple_border(const Chart& chart);

/// Tells whether the border keeps clear of itself: no two of its points are nearer than `distance` in the plane while
/// three times as far apart in space. Otherwise parts of the surface that are not neighbours would bleed into one
/// another. The chart's uvs must have the surface's area. A `distance` below a ten-thousandth of the border's length
/// counts as that.
bool keeps_clear(const Surface& surface, const Chart& chart, double distance);

/// Scales the uvs so that their area equals that of the surface.
void equalise_area(const Surface& surface, Chart& chart);

}  // namespace kiln
