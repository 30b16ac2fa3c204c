// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mesh/triangle_mesh.h"
#include "raycast/ray_scene.h"

namespace kiln {

/// Finds where a line meets a surface by walking over it from a nearby triangle, edge by edge. Neighbouring points thus
/// cost next to nothing. May be used by several threads at once.
class SurfaceWalk {
 public:
  /// Keeps a reference to `mesh`. Triangles are neighbours where they share an edge by position, and are of one part
  /// where `part_of` has their parts.
  explicit SurfaceWalk(const TriangleMesh& mesh, const std::vector<std::uint32_t>& part_of = {});

  /// Finds where the line through `point` along the unit vector `normal` meets the surface, starting at triangle
  /// `start`; the result's distance is from `point`, signed, positive along `normal`. Nothing is found where the walk
  /// comes to a border or to surface that does not face `normal`, or takes too long.
  SurfacePoint meet(const Eigen::Vector3f& point, const Eigen::Vector3f& normal, std::uint32_t start) const;

 private:
  const TriangleMesh* mesh_;
  std::vector<std::array<std::uint32_t, 3>> neighbours_;  ///< neighbour opposite each corner
};

}  // namespace kiln
