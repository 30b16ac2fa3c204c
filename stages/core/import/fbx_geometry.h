// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "import/fbx_objects.h"

namespace kiln {

/// Polygons of one FBX geometry, in its own space.
struct FbxGeometry {
  static constexpr std::uint32_t none = ~0u;

  struct Corner {
    std::uint32_t vertex = 0;
    std::uint32_t normal = none, uv = none, color = none;
  };

  std::vector<Eigen::Vector3d> vertices;
  std::vector<Eigen::Vector3d> normals;
  std::vector<Eigen::Vector2f> uvs;
  std::vector<Eigen::Vector3f> colors;
  std::vector<Corner> corners;
  std::vector<std::uint32_t> first_corner;  ///< first corner of every polygon, then the number of all corners
  std::vector<std::int64_t> materials;      ///< per polygon: index among its model's materials
  bool is_float = true;                     ///< the coordinates were once floats
  double largest = 0;                       ///< largest absolute coordinate
  std::size_t uv_sets = 0;
  std::size_t lines = 0;  ///< number of polygons of fewer than three corners, which are left out
};

/// Reads a geometry. Throws BadInput that names the geometry and the element.
FbxGeometry read_fbx_geometry(const FbxDocument& document, const FbxObjects::Object& object);

}  // namespace kiln
