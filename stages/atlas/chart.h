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

/// Whether no triangle is flipped or empty and every uv is finite.
bool is_flip_free(const Chart& chart);

/// Whether the border is a simple polygon; with no flipped triangle that means that the chart does not overlap itself
/// (Lipman, "Bijective mappings of meshes with boundary and the degree in mesh processing", 2014).
bool has_simple_border(const Chart& chart);

/// Scales the uvs so that their area is that of the surface.
void equalise_area(const Surface& surface, Chart& chart);

}  // namespace kiln
