// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "import/source_mesh.h"

namespace kiln {

/// Material of a Wavefront MTL file.
struct LibraryMaterial {
  SourceMaterial material;
  std::optional<BadInput> fault;        ///< reason why it cannot be used
  bool is_transparent = false;          ///< d below 1, Tr between 0 and 1, or map_d
  bool is_emissive = false;             ///< Ke above 0, or map_Ke
  bool is_clamped = false;              ///< Kd was outside 0 to 1 and is clamped
  std::vector<std::string> other_maps;  ///< maps other than Kd, d and Ke, as the file writes them
};

/// Reads the diffuse reflectance of materials, in the file's order: `Kd`, and `map_Kd` with its options before or after
/// the picture's name. Whatever is not understood, or a picture that does not exist, becomes the material's `fault`,
/// since materials that no face uses must not matter. Names are as in the file, including what may be a comment. Throws
/// BadInput where the file cannot be read.
std::vector<LibraryMaterial> read_material_library(const std::filesystem::path& file);

}  // namespace kiln
