// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// Part of a mesh as rays and searches see it, alone. What they find has the triangles' numbers in the whole mesh. All
/// queries may be called from many threads at once.
class PartScene {
 public:
  /// Takes the whole of a mesh. Keeps no reference.
  explicit PartScene(const TriangleMesh& mesh) : scene_(mesh) {}

  /// Takes these triangles of a mesh, at least one. Keeps no reference.
  PartScene(const TriangleMesh& mesh, std::vector<std::uint32_t> triangles);

  // The functions below are those of RayScene.
  SurfacePoint first_hit(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction, float nearest,
                         float farthest) const {
    return numbered(scene_.first_hit(origin, direction, nearest, farthest));
  }
  SurfacePoint closest_point(const Eigen::Vector3f& point, float farthest) const {
    return numbered(scene_.closest_point(point, farthest));
  }
  SurfacePoint closest_facing_point(const Eigen::Vector3f& point, const Eigen::Vector3f& facing, float farthest) const {
    return numbered(scene_.closest_facing_point(point, facing, farthest));
  }

 private:
  SurfacePoint numbered(SurfacePoint point) const {
    if (point.found() && !triangles_.empty()) point.triangle = triangles_[point.triangle];
    return point;
  }

  std::vector<std::uint32_t> triangles_;  ///< numbers in the whole mesh; empty: all of it
  RayScene scene_;
};

/// Lists the triangles, or points, of each of `count` parts; `part_of` has the part of each.
std::vector<std::vector<std::uint32_t>> listed_by_part(const std::vector<std::uint32_t>& part_of, std::size_t count);

/// Makes the scenes of `count` parts of a mesh; empty `part_of`: of the whole mesh alone.
std::vector<PartScene> scenes_of_parts(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of,
                                       std::size_t count);

/// Returns the mesh of the triangles `listed` and their positions alone, in the frame of `mesh`.
TriangleMesh part_of_mesh(const TriangleMesh& mesh, const std::vector<std::uint32_t>& listed);

/// Renumbers the corners of triangles so that those of different parts share no vertex. Empty `part_of`: they are all
/// of one.
std::vector<Triangle> taken_apart(const std::vector<Triangle>& triangles, const std::vector<std::uint32_t>& part_of);

}  // namespace kiln
