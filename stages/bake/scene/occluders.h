// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <vector>

#include "material/scene_mesh.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Meshes of a bake that cast shadows and that light bounces off, as one; with corner normals where one of the meshes
/// has them.
struct Occluders : SceneMesh {
  std::vector<Eigen::Vector3f> hull;  ///< corners of its convex hull
  bool closed = false;                ///< is_closed of every mesh
};

/// Joins meshes, at least one, with one albedo each or none.
Occluders join_occluders(const std::vector<TriangleMesh>& meshes, std::vector<SurfaceAlbedo> albedos = {});

}  // namespace kiln
