// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "sh/transfer.h"

namespace kiln {

/// What light bounces off: a mesh, cut until no edge is long, and points of them at which transfer is known.
/// Between its three points a triangle has it linear.
struct SurfaceCache {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 3>> points;  ///< of each triangle's corners

  // Of each point.
  std::vector<Eigen::Vector3f> point_positions;
  std::vector<Eigen::Vector3f> point_normals;
  std::vector<Eigen::Vector3f> point_albedos;  ///< linear red, green and blue, 0 to 1
  bool grey = true;                            ///< whether these are the same everywhere

  std::size_t size() const { return point_positions.size(); }
  Receivers receivers() const { return {point_positions, point_normals}; }
};

/// Linear red, green and blue at a point of a triangle of the mesh: u is the weight of its second corner, v that of the
/// third.
using AlbedoAt = std::function<Eigen::Vector3f(std::uint32_t triangle, float u, float v)>;

/// Edges are halved until none is longer than `longest_edge`, a fraction of the mesh's diagonal (that of their
/// box); an edge that triangles share is cut for all of them. A vertex is one point for each of its normals where the
/// mesh has hard edges, else for each group of its triangles whose normals lie within 45 degrees, so that creases stay
/// sharp; a point of a crease or of a border stands a little
/// inside the largest of its triangles, that no ray starts in the other side of a corner. A point's albedo is the mean
/// over its triangles, weighted as they interpolate it; `grey` says whether its colours are the same everywhere.
SurfaceCache make_surface_cache(const TriangleMesh& mesh, const AlbedoAt& albedo_at, bool grey, double longest_edge);

}  // namespace kiln
