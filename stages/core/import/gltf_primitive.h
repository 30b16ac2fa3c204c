// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "import/gltf_buffers.h"
#include "import/gltf_material.h"

namespace kiln {

/// Triangles of one glTF primitive, in the mesh's own space, with the vertices that they use. Per-vertex attributes are
/// empty or as many as the positions.
struct GltfPrimitive {
  std::string place;  ///< for messages: "mesh 2, primitive 0"
  std::vector<Eigen::Vector3d> positions;
  std::vector<std::uint32_t> numbers;    ///< numbers of the vertices in the file, for messages
  std::vector<Eigen::Vector3d> normals;  ///< not normalised
  std::vector<Eigen::Vector2f> uvs;      ///< (0, 0) is a picture's lower left corner
  std::vector<Eigen::Vector3f> colors;   ///< linear
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::int32_t material = -1;
  double largest = 0;  ///< largest absolute value of the stored coordinates

  std::size_t influences = 0;         ///< number of joints per vertex
  std::vector<std::uint32_t> joints;  ///< vertex * influences + i
  std::vector<double> weights;
};

/// Parts of meshes that were ignored.
struct GltfPassedBy {
  std::size_t points = 0, lines = 0;
  std::size_t without_positions = 0;
  std::size_t morphed = 0;  ///< primitives with morph targets
};

/// Reads the primitives of a mesh that hold triangles, at the given weights of their morph targets (none: 0 for all).
/// Throws BadInput that names mesh, primitive and number. `triangles_so_far` counts those of other meshes.
std::vector<GltfPrimitive> read_gltf_mesh(const GltfDocument& document, GltfBuffers& buffers, std::size_t mesh,
                                          const std::vector<double>& morph_weights,
                                          const std::vector<GltfMaterial>& materials, std::size_t triangles_so_far,
                                          GltfPassedBy& passed_by);

}  // namespace kiln
