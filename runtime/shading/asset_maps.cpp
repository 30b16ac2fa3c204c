// SPDX-License-Identifier: MIT
#include "runtime/shading/asset_maps.h"

#include <algorithm>
#include <cstdint>

#include "gpu/program.h"
#include "image/image.h"
#include "runtime/draw/asset_uploads.h"

namespace kiln {

namespace {

/// Formats of an array of pictures: on the GPU, and of the values.
struct MapFormat {
  GLenum stored, given, type;
};

/// Uploads pictures of one kind; null: the mesh has none.
template <class Value>
PackedMaps pack(const std::vector<const Image<Value>*>& pictures, const MapFormat& format, int levels) {
  PackedMaps packed;
  int width = 1, height = 1, count = 0;
  for (const Image<Value>* picture : pictures) {
    packed.layers.push_back(picture == nullptr ? -1 : count++);
    if (picture == nullptr) continue;
    width = std::max(width, picture->width());
    height = std::max(height, picture->height());
  }
  packed.parts.assign(pictures.size(), Eigen::Vector2f::Ones());
  if (count == 0) return packed;
  require_at_most(GL_MAX_TEXTURE_SIZE, std::max(width, height), "textures with a side");
  require_at_most(GL_MAX_ARRAY_TEXTURE_LAYERS, count, "texture arrays with layers");
  packed.texture = make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(packed.texture.name(), levels, format.stored, width, height, count);
  check_gl("making room for the maps of assets");
  glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
  for (std::size_t k = 0; k < pictures.size(); ++k) {
    const Image<Value>* picture = pictures[k];
    if (picture == nullptr) continue;
    Image<Value> layer(width, height, picture->channels());
    for (int j = 0; j < height; ++j)
      for (int i = 0; i < width; ++i)
        for (int c = 0; c < picture->channels(); ++c)
          layer.at(i, j, c) = picture->at(std::min(i, picture->width() - 1), std::min(j, picture->height() - 1), c);
    glTextureSubImage3D(packed.texture.name(), 0, 0, 0, packed.layers[k], width, height, 1, format.given, format.type,
                        layer.values().data());
    packed.parts[k] = Eigen::Vector2f(picture->width(), picture->height())
                          .cwiseQuotient(Eigen::Vector2f(static_cast<float>(width), static_cast<float>(height)));
  }
  set_linear_sampling(packed.texture);
  if (levels > 1) {
    glGenerateTextureMipmap(packed.texture.name());
    glTextureParameteri(packed.texture.name(), GL_TEXTURE_MIN_FILTER, GL_LINEAR_MIPMAP_LINEAR);
  }
  check_gl("uploading the maps of assets");
  return packed;
}

Eigen::Vector3f color_of(const PrtAsset* asset) {
  if (asset == nullptr) return Eigen::Vector3f::Ones();
  return asset->albedo.known ? asset->albedo.constant : Eigen::Vector3f::Constant(unknown_albedo);
}

}  // namespace

AssetMaps upload_asset_maps(std::span<const ShadedMesh> meshes) {
  AssetMaps maps;
  std::vector<const Image<std::uint8_t>*> albedo, opacity;
  std::vector<Image<std::uint16_t>> normals(meshes.size());
  std::vector<const Image<std::uint16_t>*> normal_pointers;
  int levels = 1;
  for (std::size_t k = 0; k < meshes.size(); ++k) {
    const PrtAsset* asset = meshes[k].asset;
    const auto shipped = [&](const Image<std::uint8_t>& picture) {
      return picture.values().empty() ? nullptr : &picture;
    };
    albedo.push_back(asset == nullptr ? nullptr : shipped(asset->albedo.picture));
    opacity.push_back(asset == nullptr ? nullptr : shipped(asset->opacity));
    if (asset != nullptr && !asset->normals_file.empty()) normals[k] = object_normals(*asset);
    normal_pointers.push_back(normals[k].values().empty() ? nullptr : &normals[k]);
    const bool is_picture = albedo.back() != nullptr;
    maps.colors.push_back(color_of(asset));
    maps.albedo_levels.push_back(is_picture ? albedo_levels(*asset) : 1);
    maps.albedo_texels.push_back(is_picture ? std::max(albedo.back()->width(), albedo.back()->height()) : 1);
    levels = std::max(levels, maps.albedo_levels.back());
  }
  maps.albedo = pack(albedo, {GL_SRGB8, GL_RGB, GL_UNSIGNED_BYTE}, levels);
  maps.opacity = pack(opacity, {GL_R8, GL_RED, GL_UNSIGNED_BYTE}, 1);
  maps.normals = pack(normal_pointers, {GL_RGB16, GL_RGB, GL_UNSIGNED_SHORT}, 1);
  return maps;
}

}  // namespace kiln
