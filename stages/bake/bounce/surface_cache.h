#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "bake/bounce/gather_engine.h"
#include "bake/scene/occluders.h"

namespace kiln {

/// What light bounces off: the occluders, cut until no edge is long, and points of them at which transfer is known.
/// Between its three points a triangle has it linear.
struct SurfaceCache {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 3>> points;  ///< of each triangle's corners
  std::vector<Eigen::Vector3f> hull;
  bool closed = false;

  // Of each point.
  std::vector<Eigen::Vector3f> point_positions;
  std::vector<Eigen::Vector3f> point_normals;
  std::vector<Eigen::Vector3f> point_albedos;  ///< linear red, green and blue, 0 to 1
  bool grey = true;                            ///< whether these are the same everywhere

  std::size_t size() const { return point_positions.size(); }
  Receivers receivers() const { return {point_positions, point_normals}; }
  ReflectingSurface surface() const { return {positions, triangles, points, hull, closed}; }
};

/// Edges are halved until none is longer than `longest_edge`, a fraction of the occluders' diagonal (that of their
/// box); an edge that triangles share is cut for all of them. A vertex is one point for each group of its triangles
/// whose normals lie within 45 degrees, so that creases stay sharp; a point of a crease or of a border stands a little
/// inside the largest of its triangles, that no ray starts in the other side of a corner. A point's albedo is the mean
/// over its triangles, weighted as they interpolate it.
SurfaceCache make_surface_cache(const Occluders& occluders, double longest_edge);

}  // namespace kiln
