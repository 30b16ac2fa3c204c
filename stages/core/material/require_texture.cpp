// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/require_texture.h"

#include "base/errors.h"

namespace kiln {

namespace {

/// Refuses a textured face that has no texture coordinates; `owner` names whose texture it is.
void refuse(const ImportedMesh& mesh, const ImportedSurface::FaceWithoutUvs& missing, const std::string& owner,
            const std::string& remedy) {
  if (!missing.found) return;
  const std::string place = missing.line > 0 ? ":" + std::to_string(missing.line) : "";
  const std::string face = missing.line > 0 ? "a face" : "face " + std::to_string(missing.face);
  throw BadInput(mesh.file.string() + place, face + " without texture coordinates" + owner,
                 "texture coordinates at every corner of it", remedy);
}

}  // namespace

std::string picture_name(const SourcePicture& picture) {
  return picture.bytes != nullptr ? picture.name : picture.file.string();
}

void require_picture(const SourceTexture& texture, const std::filesystem::path& mesh_file, const std::string& option) {
  std::error_code error;
  if (texture.picture.bytes != nullptr || std::filesystem::is_regular_file(texture.picture.file, error)) return;
  throw BadInput(texture.place.empty() ? mesh_file.string() : texture.place,
                 "names the picture " + picture_name(texture.picture) + ", which does not exist", "a file",
                 "put it there, or " + option);
}

void require_uvs(const ImportedMesh& mesh, std::size_t material) {
  refuse(mesh, mesh.surface.without_uvs[material],
         ", of material '" + mesh.surface.materials[material].name + "', which has a texture",
         "export the mesh again with them");
}

void require_uvs_everywhere(const ImportedMesh& mesh, const std::string& option) {
  const std::string remedy = "export the mesh with them, or leave " + option + " out";
  if (mesh.surface.uvs.empty())
    throw BadInput(mesh.file.string(), "has no texture coordinates",
                   "a mesh with texture coordinates, to look up the texture with", remedy);
  for (const ImportedSurface::FaceWithoutUvs& missing : mesh.surface.without_uvs) refuse(mesh, missing, "", remedy);
}

}  // namespace kiln
