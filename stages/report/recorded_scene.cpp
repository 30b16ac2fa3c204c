// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/recorded_scene.h"

#include <algorithm>

#include "material/cut_out.h"
#include "material/load_albedo.h"
#include "material/surroundings.h"
#include "report/transport.h"

namespace kiln {

MaterialSettings material_of(const Json& record) { return settings_of(record, add_material_options); }

bool is_on_low(const AssetFolder& asset) {
  return asset.record("bake").at("settings").value("receiver", std::string("high")) == "low";
}

MaterialSettings surface_material(const AssetFolder& asset) {
  const MaterialSettings of_bake = material_of(asset.record("bake"));
  return of_bake.albedo || !of_bake.reflectance.empty() ? of_bake : map_material(asset);
}

MaterialSettings map_material(const AssetFolder& asset) {
  return material_of(asset.record(asset.is_per_vertex() ? "bake" : "normals"));
}

bool high_casts_shadows(const AssetFolder& asset) {
  const Json high = asset.record("simplify").value("inputs", Json::object()),
             inputs = asset.record("bake").value("inputs", Json::object());
  return !high.empty() && std::ranges::find(inputs, *high.begin()) != inputs.end();
}

SceneMesh scene_of(const AssetFolder& asset, const ImportedMesh& own_mesh, bool bounces) {
  const Json& bake = asset.record("bake");
  Surroundings surroundings = settings_of(bake, add_surroundings_options);
  surroundings.neighbours = bake.value("neighbours", surroundings.neighbours);
  const MaterialSettings material = material_of(bake);
  SceneMesh scene;
  const auto add = [&](const TriangleMesh& mesh, const SurfaceAlbedo& albedo) {
    if (bounces)
      scene.add(mesh, albedo);
    else
      scene.add(mesh);
  };
  TriangleMesh own = own_mesh.mesh;
  SurfaceAlbedo albedo = bounces ? load_albedo(own_mesh, material).albedo : SurfaceAlbedo();
  cut_occluder(own, albedo, load_opacity(own_mesh, material).opacity, own_mesh.file.string());
  add(own, albedo);
  for (const PlacedMesh& placed :
       load_surroundings(surroundings, bounding_box(own_mesh.mesh), material, bounces, own_mesh.mesh.frame))
    add(placed.mesh, placed.material.albedo);
  return scene;
}

int error_bounces(const AssetFolder& asset, const ReportSettings& settings) {
  return settings.error_bounces.value_or(static_cast<int>(bounces_taken(asset.record("bake"))));
}

}  // namespace kiln
