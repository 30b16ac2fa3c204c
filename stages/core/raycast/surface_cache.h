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

/// The surface that light bounces off: a mesh, cut until no edge is long, and points on it at which transfer is known.
/// Transfer is interpolated linearly between the three points of a triangle.
struct SurfaceCache {
  std::vector<Eigen::Vector3f> positions;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::array<std::uint32_t, 3>> points;  ///< for each triangle, the points of its corners

  // Data of each point.
  std::vector<Eigen::Vector3f> point_positions;
  std::vector<Eigen::Vector3f> point_normals;
  std::vector<Eigen::Vector3f> point_albedos;  ///< linear red, green and blue, 0 to 1
  bool grey = true;                            ///< whether every albedo has equal red, green and blue

  std::size_t size() const { return point_positions.size(); }
  Receivers receivers() const { return {point_positions, point_normals}; }
};

/// Linear red, green and blue at a point of a triangle of the mesh; u is the weight of its second corner, v that of its
/// third.
using AlbedoAt = std::function<Eigen::Vector3f(std::uint32_t triangle, float u, float v)>;

/// Cuts the mesh and makes its points. Edges are halved until none is longer than `longest_edge`, a fraction of the
/// diagonal of the mesh's box; an edge that triangles share is cut for all of them. A vertex becomes one point for each
/// of its normals if the mesh has hard edges, else one for each group of its triangles whose normals lie within 45
/// degrees of each other, so that creases stay sharp. A point of a crease or border stands a little inside the largest
/// of its triangles, so that no ray starts within the other side of a corner. A point's albedo is the mean over its
/// triangles, weighted by interpolation; `grey` says that colours do not differ between channels.
SurfaceCache make_surface_cache(const TriangleMesh& mesh, const AlbedoAt& albedo_at, bool grey, double longest_edge);

}  // namespace kiln
