// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "import/gltf_buffers.h"

namespace kiln {

/// Mesh with the transform that a node of the scene gives it.
struct GltfPlacement {
  std::size_t mesh = 0;
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
  std::vector<double> morph_weights;
  std::string name;  ///< of the node, or of the mesh where that has none
  /// Transforms of a skinned mesh's joints, from the mesh's space to the world's, at rest; null for other meshes.
  std::shared_ptr<const std::vector<Eigen::Matrix4d>> joints;
};

/// Lists the meshes of the default scene (else of all nodes; else all meshes, untransformed), in the order of the
/// nodes' tree. Adds what is ignored to `warnings`. Throws BadInput for node graphs that are not trees.
std::vector<GltfPlacement> place_gltf_meshes(const GltfDocument& document, GltfBuffers& buffers,
                                             std::vector<std::string>& warnings);

}  // namespace kiln
