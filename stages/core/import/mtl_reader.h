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
  std::optional<BadInput> fault;         ///< reason why it cannot be used
  bool is_clamped = false;               ///< Kd was outside 0 to 1 and is clamped
  std::vector<std::string> unread_maps;  ///< sentences about maps, other than Kd, that cannot be read
  std::vector<std::string> other_maps;   ///< maps that Kiln has no use for, as the file writes them
};

/// Reads materials in the file's order: `Kd`, `d`, `Ke`, `Pr`, `Pm` and their maps, with options before or after the
/// picture's name. What is not understood of Kd, or a picture of it that does not exist, becomes the material's
/// `fault`, since materials that no face uses must not matter. Names are as in the file, including what may be a
/// comment. Throws BadInput where the file cannot be read.
std::vector<LibraryMaterial> read_material_library(const std::filesystem::path& file);

}  // namespace kiln
