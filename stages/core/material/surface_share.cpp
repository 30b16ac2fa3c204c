// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surface_share.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <stdexcept>
#include <utility>

#include "material/require_texture.h"

namespace kiln {

SurfaceShare::SurfaceShare(Materials materials) : constant_(1) {
  const bool has_texture =
      std::ranges::any_of(materials.all, [](const Material& material) { return material.texture != nullptr; });
  if (has_texture && materials.uvs.size() != materials.of_triangle.size())
    throw std::invalid_argument("SurfaceShare: texture coordinates for every triangle are needed");
  materials_ = std::make_shared<const Materials>(std::move(materials));
}

float SurfaceShare::at(std::uint32_t triangle, float u, float v) const {
  if (materials_ == nullptr) return constant_;
  const Material& material = materials_->all[materials_->of_triangle[triangle]];
  if (material.texture == nullptr) return material.factor;
  const std::array<Eigen::Vector2f, 3>& uvs = materials_->uvs[triangle];
  const Eigen::Vector2f uv = (1 - u - v) * uvs[0] + u * uvs[1] + v * uvs[2];
  return material.factor *
         material.texture->at(material.texture_transform * uv.homogeneous(), material.wrap_u, material.wrap_v);
}

LoadedShare load_share(const ImportedMesh& mesh, SourceShare SourceMaterial::*member, float otherwise,
                       const std::string& option) {
  const ImportedSurface& surface = mesh.surface;
  LoadedShare loaded{SurfaceShare(otherwise), {}};
  const bool is_given = std::ranges::any_of(
      surface.materials, [&](const SourceMaterial& material) { return (material.*member).is_given(); });
  if (!is_given || surface.material_of.empty()) return loaded;

  SurfaceShare::Materials materials;
  std::map<std::pair<std::string, int>, std::shared_ptr<const ChannelTexture>> known;
  for (std::size_t m = 0; m < surface.materials.size(); ++m) {
    const SourceShare& source = surface.materials[m].*member;
    SurfaceShare::Material& material = materials.all.emplace_back();
    material.factor = source.factor.value_or(source.texture ? 1 : otherwise);
    if (!source.texture) continue;
    const SourceTexture& texture = *source.texture;
    require_picture(texture, mesh.file, option);
    require_uvs(mesh, m);
    // Pictures of one file may be read with several ranges, which no mesh at hand has: they are read again.
    const bool is_plain = texture.base == 0 && texture.gain == 1;
    std::shared_ptr<const ChannelTexture> made;
    std::shared_ptr<const ChannelTexture>& entry =
        is_plain ? known[{picture_name(texture.picture), static_cast<int>(source.channel)}] : made;
    if (entry == nullptr)
      entry = std::make_shared<const ChannelTexture>(texture.picture, source.channel, texture.base, texture.gain);
    material.texture = entry;
    material.texture_transform = texture.transform;
    material.wrap_u = texture.wrap_u;
    material.wrap_v = texture.wrap_v;
    if (texture.picture.bytes == nullptr && std::ranges::find(loaded.files, texture.picture.file) == loaded.files.end())
      loaded.files.push_back(texture.picture.file);
  }
  const auto plain = static_cast<std::uint32_t>(materials.all.size());
  materials.all.push_back({.factor = otherwise});  // for faces without a material
  materials.of_triangle.reserve(surface.material_of.size());
  for (const std::int32_t material : surface.material_of)
    materials.of_triangle.push_back(material < 0 ? plain : static_cast<std::uint32_t>(material));
  materials.uvs = surface.uvs;
  loaded.share = SurfaceShare(std::move(materials));
  return loaded;
}

}  // namespace kiln
