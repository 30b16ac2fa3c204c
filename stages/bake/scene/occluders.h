// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "material/scene_mesh.h"
#include "material/wavelength_albedo.h"
#include "mesh/triangle_mesh.h"

namespace kiln {

/// Meshes of a bake that cast shadows and that light bounces off, as one; with corner normals where one of the meshes
/// has them.
struct Occluders : SceneMesh {
  std::vector<Eigen::Vector3f> hull;  ///< corners of its convex hull
  bool closed = false;                ///< is_closed of every mesh
  /// 1 for each triangle of a sheet that opacity cuts, such as a leaf: it encloses nothing; empty where none is.
  std::vector<std::uint8_t> sheets;
  /// Reflectances of a bake by wavelengths; empty where light bounces as red, green and blue.
  std::optional<SceneReflectance> reflectance = {};
};

/// Returns the triangles that may enclose something: all but those of sheets.
std::vector<Triangle> enclosing_triangles(const Occluders& occluders);

/// Joins meshes, at least one, with one albedo each or none.
Occluders join_occluders(const std::vector<TriangleMesh>& meshes, std::vector<SurfaceAlbedo> albedos = {});

}  // namespace kiln
