// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <span>
#include <string>
#include <vector>

#include "import/fbx_objects.h"
#include "import/source_mesh.h"

namespace kiln {

/// Reads the materials of an FBX file when models ask for them.
class FbxMaterials {
 public:
  FbxMaterials(const FbxDocument& document, const FbxObjects& objects) : document_(document), objects_(objects) {}

  /// Returns the index of a material in all(). Throws BadInput.
  std::int32_t number_of(const FbxObjects::Object& material);

  std::vector<SourceMaterial> all() && { return std::move(materials_); }

  /// Adds warnings about what was ignored.
  void add_warnings(std::vector<std::string>& warnings) const;

 private:
  SourceMaterial read(const FbxObjects::Object& object);
  SourceTexture read_texture(const FbxObjects::Object& object);
  SourcePicture picture(const FbxObjects::Object& texture) const;
  /// Finds the picture connected to the first of these properties that has one; null where none has.
  const FbxObjects::Object* texture_of(const FbxObjects::Object& material, std::span<const char* const> properties);

  const FbxDocument& document_;
  const FbxObjects& objects_;
  std::map<std::int64_t, std::int32_t> numbers_;
  std::vector<SourceMaterial> materials_;
  std::size_t layered_ = 0, turned_ = 0;
};

}  // namespace kiln
