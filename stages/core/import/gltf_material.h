// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "import/gltf_buffers.h"
#include "import/source_mesh.h"

namespace kiln {

struct GltfMaterial {
  SourceMaterial material;
  std::size_t uv_set = 0;  ///< set of texture coordinates for the picture: TEXCOORD_<uv_set>
};

/// Reads all materials of a file, in its order: metal-roughness, emission and alpha, or the diffuse colour of
/// KHR_materials_pbrSpecularGlossiness. Adds what is ignored to `warnings`. Throws BadInput.
std::vector<GltfMaterial> read_gltf_materials(const GltfDocument& document, GltfBuffers& buffers,
                                              std::vector<std::string>& warnings);

}  // namespace kiln
