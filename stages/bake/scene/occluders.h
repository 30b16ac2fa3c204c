#pragma once

#include <vector>

#include "mesh/triangle_mesh.h"

namespace kiln {

/// What casts shadows, all meshes as one.
struct Occluders {
  TriangleMesh mesh;                  ///< positions and triangles
  std::vector<Eigen::Vector3f> hull;  ///< the corners of its convex hull
  bool closed = false;                ///< is_closed of every mesh
};

/// Joins meshes, at least one.
Occluders join_occluders(const std::vector<TriangleMesh>& meshes);

}  // namespace kiln
