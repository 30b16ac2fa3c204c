// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "material/surface_albedo.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Meshes joined into one, each with its albedo: what casts shadows, and what light bounces off.
struct SceneMesh {
  TriangleMesh mesh;                           ///< positions and triangles
  std::vector<std::uint32_t> first_triangles;  ///< first triangle of each mesh
  std::vector<SurfaceAlbedo> albedos;          ///< albedo of each mesh; empty if light does not bounce

  /// Appends the positions and triangles of a mesh. Meshes have all an albedo or none.
  void add(const TriangleMesh& part);
  void add(const TriangleMesh& part, SurfaceAlbedo albedo);

  /// Returns the number of the mesh that a triangle of `mesh` is of.
  std::size_t part_of(std::uint32_t triangle) const;

  /// Returns the albedo, linear red, green and blue, at a point of a triangle of `mesh`: u weighs its second corner, v
  /// its third.
  Eigen::Vector3f albedo_at(std::uint32_t triangle, float u, float v) const;

  /// Returns whether all albedos are grey, so that one channel of bounced light serves for all.
  bool is_grey() const;
};

}  // namespace kiln
