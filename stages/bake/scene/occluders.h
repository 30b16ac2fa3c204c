// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// What casts shadows and what light bounces off, all meshes as one.
struct Occluders {
  TriangleMesh mesh;                  ///< positions, triangles and, where one of the meshes has them, corner normals
  std::vector<Eigen::Vector3f> hull;  ///< the corners of its convex hull
  bool closed = false;                ///< is_closed of every mesh

  std::vector<std::uint32_t> first_triangles;  ///< of each mesh
  std::vector<SurfaceAlbedo> albedos;          ///< of each mesh; none where nothing was asked for

  Eigen::Vector3f albedo_at(std::uint32_t triangle, float u, float v) const;
  bool grey() const;
};

/// Joins meshes, at least one, with as many albedos or none.
Occluders join_occluders(const std::vector<TriangleMesh>& meshes, std::vector<SurfaceAlbedo> albedos = {});

}  // namespace kiln
