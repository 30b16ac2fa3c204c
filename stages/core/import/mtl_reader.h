#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/errors.h"
#include "import/source_mesh.h"

namespace kiln {

/// One material of a Wavefront MTL file.
struct LibraryMaterial {
  SourceMaterial material;
  std::optional<BadInput> fault;        ///< why it cannot be used
  bool is_transparent = false;          ///< d below 1, Tr between 0 and 1, or map_d
  bool is_emissive = false;             ///< Ke above 0, or map_Ke
  bool is_clamped = false;              ///< Kd outside 0 to 1, clamped to that
  std::vector<std::string> other_maps;  ///< maps of neither Kd nor d nor Ke, as the file writes them
};

/// Reads the diffuse reflectance of materials, in the file's order: `Kd`, and `map_Kd` with its options before or
/// behind the picture's name. What of a material is not understood, and a picture that is not there, is its `fault`, as
/// a material that no face uses is no concern. Names are as the file has them, with what may be a comment. Throws
/// BadInput where the file cannot be read.
std::vector<LibraryMaterial> read_material_library(const std::filesystem::path& file);

}  // namespace kiln
