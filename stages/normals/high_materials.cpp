// SPDX-License-Identifier: GPL-3.0-or-later
#include "normals/high_materials.h"

#include <algorithm>

#include "material/load_albedo.h"

namespace kiln {

namespace {

template <class Value>
void add(std::vector<Value>& all, const std::vector<Value>& more) {
  for (const Value& value : more)
    if (std::ranges::find(all, value) == all.end()) all.push_back(value);
}

}  // namespace

HighMaterials load_high_materials(const ImportedMesh& high, const NormalsSettings& settings) {
  HighMaterials materials;
  const LoadedAlbedo albedo = load_albedo(high, settings.material);
  materials.albedo = albedo.albedo;
  add(materials.files, albedo.files);
  add(materials.warnings, albedo.warnings());
  const LoadedOpacity opacity = load_opacity(high, settings.material);
  materials.opacity = opacity.opacity;
  add(materials.files, opacity.files);
  add(materials.warnings, opacity.warnings);

  const auto wants = [&](MapKind kind) {
    return std::ranges::find(settings.maps.kinds, kind) != settings.maps.kinds.end();
  };
  const auto load = [&](SourceShare SourceMaterial::*member, float otherwise) {
    LoadedShare loaded = load_share(high, member, otherwise, "take its map out of --maps");
    add(materials.files, loaded.files);
    return loaded.share;
  };
  if (wants(MapKind::material)) materials.ids = find_material_ids(high);
  if (wants(MapKind::roughness) || wants(MapKind::orm)) materials.roughness = load(&SourceMaterial::roughness, 1);
  if (wants(MapKind::metalness) || wants(MapKind::orm)) materials.metalness = load(&SourceMaterial::metalness, 0);
  if (wants(MapKind::emission)) {
    const LoadedAlbedo emission = load_emission(high);
    materials.emission = emission.albedo;
    add(materials.files, emission.files);
  }
  return materials;
}

}  // namespace kiln
