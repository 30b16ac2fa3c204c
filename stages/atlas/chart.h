#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "atlas/surface.h"

namespace kiln {

/// How a chart was flattened. It was relaxed afterwards (relax.h).
enum class Parameteriser { unfolded, lscm, arap, mean_value };

/// A topological disk of the surface and its place in the plane, in object units.
struct Chart {
  std::vector<std::uint32_t> faces;     ///< of the mesh
  std::vector<Triangle> triangles;      ///< parallel to `faces`, corners as in the mesh, into `vertices`
  std::vector<std::uint32_t> vertices;  ///< of the mesh; at a slit two of these may be the same
  std::vector<Eigen::Vector2d> uvs;     ///< per vertex; as large as the surface once scaled by equalise_area
  Parameteriser parameteriser = Parameteriser::unfolded;
};

/// Twice the signed area of a triangle.
inline double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c) {
  return (b.x() - a.x()) * (c.y() - a.y()) - (b.y() - a.y()) * (c.x() - a.x());
}

/// An edge with a triangle on one side only, between two vertices of the chart; the chart lies on its left.
struct BorderEdge {
  std::uint32_t from, to;
};

/// In no particular order.
std::vector<BorderEdge> border_edges(const Chart& chart);

/// Whether no triangle is flipped or empty and every uv is finite.
bool is_flip_free(const Chart& chart);

/// Whether the border is a simple polygon; with no flipped triangle that means that the chart does not overlap itself
/// (Lipman, "Bijective mappings of meshes with boundary and the degree in mesh processing", 2014).
bool has_simple_border(const Chart& chart);

/// Whether no two points of the border are nearer to one another in the plane than `distance` while being three times
/// as far apart in space: parts of the surface that have nothing to do with one another would bleed into one another. A
/// chart's uvs must be as large as the surface. Less than a ten-thousandth of the border's length counts as that.
bool keeps_clear(const Surface& surface, const Chart& chart, double distance);

/// Scales the uvs so that their area is that of the surface.
void equalise_area(const Surface& surface, Chart& chart);

}  // namespace kiln
