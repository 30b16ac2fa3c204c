// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "import/import_mesh.h"

namespace kiln {

/// Returns the name of a picture for messages, which is one for each picture: its file, or its place in the mesh file.
std::string picture_name(const SourcePicture& picture);

/// Throws BadInput where a material's picture is a file that does not exist; `option` is what helps without it.
void require_picture(const SourceTexture& texture, const std::filesystem::path& mesh_file, const std::string& option);

/// Throws BadInput where a face of a material, which has a texture, is without texture coordinates.
void require_uvs(const ImportedMesh& mesh, std::size_t material);

/// Throws BadInput where a face is without texture coordinates, for a picture that the user gives for all faces by
/// `option`.
void require_uvs_everywhere(const ImportedMesh& mesh, const std::string& option);

}  // namespace kiln
