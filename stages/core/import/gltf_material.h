#pragma once

#include <string>
#include <vector>

#include "import/gltf_buffers.h"
#include "import/source_mesh.h"

namespace kiln {

struct GltfMaterial {
  SourceMaterial material;
  std::size_t uv_set = 0;  ///< the picture is looked up with TEXCOORD_<uv_set>
};

/// All materials of a file, in its order: the base colour of metal and roughness, or the diffuse one of
/// KHR_materials_pbrSpecularGlossiness. What is passed by is added to `warnings`. Throws BadInput.
std::vector<GltfMaterial> read_gltf_materials(const GltfDocument& document, GltfBuffers& buffers,
                                              std::vector<std::string>& warnings);

}  // namespace kiln
