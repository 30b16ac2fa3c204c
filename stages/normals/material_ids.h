// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "import/import_mesh.h"

namespace kiln {

/// Materials of a mesh's triangles as numbers: those of its file, or the parts that share no vertex where it has none.
struct MaterialIds {
  std::vector<std::uint32_t> of_triangle;
  /// By id, each once: "part 1" and so on for parts, "none" for triangles without a material.
  std::vector<std::string> names;
};

/// Finds the ids that the triangles use, in the order in which they use them.
MaterialIds find_material_ids(const ImportedMesh& mesh);

}  // namespace kiln
