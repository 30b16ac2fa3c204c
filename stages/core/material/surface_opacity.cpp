// SPDX-License-Identifier: GPL-3.0-or-later
#include "material/surface_opacity.h"

#include <algorithm>
#include <cmath>
#include <set>

#include "base/errors.h"
#include "material/require_texture.h"

namespace kiln {

namespace {

/// Tells whether a texture has much that is neither opaque nor clear, which a cutoff cannot show.
bool is_gradual(const ChannelTexture& texture) {
  constexpr float clear = 0.1f, opaque = 0.9f;
  constexpr double much = 0.25;
  std::int64_t between = 0;
  for (int j = 0; j < texture.height(); ++j)
    for (int i = 0; i < texture.width(); ++i) {
      const float value = texture.texel(i, j, SourceTexture::Wrap::clamp, SourceTexture::Wrap::clamp);
      between += value > clear && value < opaque;
    }
  return static_cast<double>(between) > much * texture.width() * texture.height();
}

std::string materials_text(std::size_t count, const std::string& what) {
  return std::to_string(count) + (count == 1 ? " material " : " materials ") + what;
}

std::string gradual_text(std::size_t count) {
  return materials_text(count, "with a picture of opacity that is gradual, cut at its cutoff (--opacity-cutoff)");
}

/// Loads the picture that the settings name for all of the surface.
LoadedOpacity load_picture(const ImportedMesh& mesh, const MaterialSettings& settings) {
  std::error_code error;
  const std::filesystem::path file = settings.opacity_texture;
  if (!std::filesystem::is_regular_file(file, error))
    throw BadInput(file.string(), "does not exist", "a picture for --opacity-texture", "check the path");
  require_uvs_everywhere(mesh, "--opacity-texture");
  const auto texture = std::make_shared<const ChannelTexture>(SourcePicture{file, nullptr, file.string()},
                                                              SourceShare::Channel::coverage);
  SurfaceShare::Materials materials;
  materials.all.push_back({.texture = texture});
  materials.of_triangle.assign(mesh.mesh.triangles.size(), 0);
  materials.uvs = mesh.surface.uvs;
  LoadedOpacity loaded;
  loaded.files = {file};
  const auto cutoff = static_cast<float>(settings.opacity_cutoff.value_or(0.5));
  if (texture->highest() < cutoff)
    throw BadInput(file.string(), "is nowhere as opaque as the cutoff", "a picture of what is there",
                   "give another picture, or a lower --opacity-cutoff");
  if (is_gradual(*texture)) loaded.warnings.push_back(gradual_text(1));
  if (texture->lowest() < cutoff) loaded.opacity = {SurfaceShare(std::move(materials)), {cutoff}};
  return loaded;
}

}  // namespace

float SurfaceOpacity::at(std::uint32_t triangle, float u, float v) const {
  if (is_opaque()) return 1;
  const float value = share_.at(triangle, u, v), cutoff = cutoffs_[share_.materials().of_triangle[triangle]];
  return value < cutoff ? 0.5f * value / cutoff : 0.5f + 0.5f * (value - cutoff) / (1 - cutoff);
}

bool SurfaceOpacity::is_sheet(std::uint32_t triangle) const {
  if (is_opaque()) return false;
  const std::uint32_t m = share_.materials().of_triangle[triangle];
  const SurfaceShare::Material& material = share_.materials().all[m];
  return material.texture != nullptr && material.factor * material.texture->lowest() < cutoffs_[m];
}

LoadedOpacity load_opacity(const ImportedMesh& mesh, const MaterialSettings& settings) {
  if (!settings.opacity_texture.empty()) return load_picture(mesh, settings);
  LoadedOpacity loaded;
  if (settings.opacity == OpacitySource::none || mesh.surface.materials_fault) return loaded;
  LoadedShare found = load_share(mesh, &SourceMaterial::opacity, 1, "give --opacity none");
  if (found.share.is_constant()) return loaded;

  // Take for opaque what no picture cuts.
  SurfaceShare::Materials materials = found.share.materials();
  const std::set<std::uint32_t> used(materials.of_triangle.begin(), materials.of_triangle.end());
  std::vector<float> cutoffs;
  std::size_t glassy = 0, gradual = 0;
  bool cuts = false;
  for (std::uint32_t m = 0; m < materials.all.size(); ++m) {
    SurfaceShare::Material& material = materials.all[m];
    const auto given = settings.opacity_cutoff;
    cutoffs.push_back(given                               ? static_cast<float>(*given)
                      : m < mesh.surface.materials.size() ? mesh.surface.materials[m].opacity_cutoff
                                                          : 0.5f);
    if (!used.contains(m)) continue;
    if (material.texture == nullptr || material.factor * material.texture->highest() < cutoffs.back()) {
      glassy += material.factor < 1 || material.texture != nullptr;
      material = {};
    } else if (material.factor * material.texture->lowest() < cutoffs.back()) {
      cuts = true;
      gradual += is_gradual(*material.texture);
    }
  }
  if (glassy > 0) loaded.warnings.push_back(materials_text(glassy, "not opaque (such as glass), taken for opaque"));
  if (gradual > 0) loaded.warnings.push_back(gradual_text(gradual));
  if (!cuts) return loaded;
  loaded.opacity = {SurfaceShare(std::move(materials)), std::move(cutoffs)};
  loaded.files = std::move(found.files);
  return loaded;
}

}  // namespace kiln
