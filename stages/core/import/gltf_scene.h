#pragma once

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

#include "import/gltf_buffers.h"

namespace kiln {

/// A mesh where a node of the scene puts it.
struct GltfPlacement {
  std::size_t mesh = 0;
  Eigen::Matrix4d world = Eigen::Matrix4d::Identity();
  std::vector<double> morph_weights;
  /// The transform of each joint of a skinned mesh: from the mesh's space to the world's, at rest. Else null.
  std::shared_ptr<const std::vector<Eigen::Matrix4d>> joints;
};

/// The meshes of the default scene (else of all nodes; else all meshes as they are), in the order of the nodes' tree.
/// What is passed by is added to `warnings`. Throws BadInput for node graphs that are no trees.
std::vector<GltfPlacement> place_gltf_meshes(const GltfDocument& document, GltfBuffers& buffers,
                                             std::vector<std::string>& warnings);

}  // namespace kiln
