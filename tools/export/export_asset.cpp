// SPDX-License-Identifier: GPL-3.0-or-later
#include "export/export_asset.h"

#include <algorithm>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <set>
#include <system_error>

#include "asset/fields.h"
#include "asset/prt_asset.h"
#include "asset/read_description.h"
#include "asset/read_parts.h"
#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/json.h"
#include "export/sky_pictures.h"
#include "export/surface_textures.h"
#include "mesh/same_position.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr const char* extension_name = "KILN_prt";
constexpr int extension_version = 1;

/// Grey of assets that do not know their albedo, as kiln-render draws them.
constexpr float unknown_albedo = 0.8f;

/// What glTF materials cut at: opacity below one half is not there.
constexpr double opacity_cutoff = 0.5;

/// Further maps that become part of the material.
constexpr std::array used_maps = {"orm", "roughness", "metalness"};

bool has_colored_transfer(const PrtAsset& asset) {
  const PrtAlbedo& albedo = asset.albedo;
  return asset.channels == 3 && albedo.known && albedo.file.empty() && albedo.constant == Eigen::Vector3f::Ones();
}

AttributedMesh mesh_of(const fs::path& folder, const PrtAsset& asset) {
  if (asset.vertices > 0) return read_vertex_mesh(folder, asset);
  return {asset.mesh, {}};
}

Json texture_of(std::size_t index) { return {{"index", index}}; }

/// Makes the material that any viewer shows. `sky` is empty for an asset baked per vertex.
Json material_of(const fs::path& folder, const PrtAsset& asset, const std::optional<SkyTransfer>& sky, GlbFile& file,
                 bool is_closed_mesh) {
  const bool is_colored = sky && has_colored_transfer(asset);
  Json surface = {{"metallicFactor", 0}, {"roughnessFactor", 1}};

  // Base colour.
  const PngBytes color = base_color_picture(folder, asset, is_colored ? color_under_sky(*sky) : Image<std::uint8_t>());
  if (!color.empty())
    surface["baseColorTexture"] = texture_of(file.add_picture(color, "base_color", GlbSampler::smooth));
  if (asset.albedo.file.empty() && !is_colored) {
    const Eigen::Vector3f factor =
        asset.albedo.known ? asset.albedo.constant : Eigen::Vector3f::Constant(unknown_albedo);
    surface["baseColorFactor"] = {factor.x(), factor.y(), factor.z(), 1};
  }

  // Roughness and metalness.
  if (const PngBytes rough = roughness_picture(folder, asset); !rough.empty()) {
    surface["metallicRoughnessTexture"] =
        texture_of(file.add_picture(rough, "occlusion_roughness_metalness", GlbSampler::smooth));
    surface["metallicFactor"] = 1;
  }

  Json material = {{"pbrMetallicRoughness", std::move(surface)}};
  if (const PngBytes normals = tangent_normal_picture(folder, asset); !normals.empty())
    material["normalTexture"] = texture_of(file.add_picture(normals, "normal", GlbSampler::smooth));
  if (sky && !is_colored)
    material["occlusionTexture"] =
        texture_of(file.add_picture(png_of(occlusion_picture(*sky)), "occlusion", GlbSampler::smooth));
  if (!asset.opacity_file.empty()) {
    material["alphaMode"] = "MASK";
    material["alphaCutoff"] = opacity_cutoff;
  }
  if (!is_closed_mesh || !asset.opacity_file.empty()) material["doubleSided"] = true;
  return material;
}

/// Adds the pictures of the planes, and the tables of a compressed asset, with the bytes of their files. Returns their
/// textures by the names that the manifest has for them.
Json add_planes(const fs::path& folder, const PrtAsset& asset, GlbFile& file) {
  std::vector<std::string> names;
  for (const PrtPlane& plane : asset.planes) names.push_back(plane.file);
  if (asset.pca) {
    names.push_back(asset.pca->vectors_file);
    if (!asset.pca->ids_file.empty()) names.push_back(asset.pca->ids_file);
  }
  Json pictures = Json::object();
  for (const std::string& name : names)
    if (!name.empty() && !pictures.contains(name))
      pictures[name] = texture_of(file.add_picture(read_text(folder / name), name, GlbSampler::exact));
  return pictures;
}

/// Returns the way from the folder of `file` to the manifest, as a relative URL has it before characters are escaped.
std::string manifest_path(const fs::path& manifest, const fs::path& file) {
  std::error_code error;
  const fs::path from = fs::weakly_canonical(folder_of(file), error), to = fs::weakly_canonical(manifest, error);
  const fs::path relative = to.lexically_relative(from);
  return text_of_path(relative.empty() ? manifest.filename() : relative);
}

std::vector<std::string> left_out(const PrtAsset& asset) {
  std::vector<std::string> warnings;
  if (!asset.levels.empty())
    warnings.push_back(fmt::format("{} level{} of detail stay{} in the folder: the file holds the finest mesh",
                                   asset.levels.size(), asset.levels.size() == 1 ? "" : "s",
                                   asset.levels.size() == 1 ? "s" : ""));
  std::vector<std::string> maps;
  const bool has_orm = std::ranges::any_of(asset.maps, [](const PrtMap& map) { return map.name == "orm"; });
  for (const PrtMap& map : asset.maps)
    if (std::ranges::find(used_maps, map.name) == used_maps.end() || (has_orm && map.name != "orm"))
      maps.push_back(map.name);
  if (!maps.empty()) warnings.push_back(fmt::format("further maps stay in the folder: {}", fmt::join(maps, ", ")));
  return warnings;
}

}  // namespace

ExportedAsset export_asset(const fs::path& folder, const fs::path& file, const ExportSettings& settings) {
  // Step 1: read the asset, all of it, so that no damaged picture gets into the file.
  const PrtAsset asset = load_prt_asset(folder);
  if (asset.channels != 1 && asset.channels != 3)
    throw BadInput(asset.ranges_file.string(), fmt::format("has {} channels", asset.channels),
                   "1, or 3 for red, green and blue, which a glTF material can show", "bake for RGB");
  if (settings.sh1 && asset.is_per_vertex())
    throw BadInput(asset.ranges_file.string(), "is baked per vertex, without pictures", "an asset with an atlas",
                   "export it without --sh1");
  std::optional<SkyTransfer> sky;
  if (!asset.is_per_vertex()) sky = sky_transfer(asset);

  // Step 2: the mesh.
  GlbFile glb;
  const AttributedMesh source = mesh_of(folder, asset);
  AddedMesh added = add_mesh(glb, glb_mesh_of(source, !asset.normals_file.empty()), settings.form);

  // Step 3: the material and, under the extension, the planes.
  const bool is_closed_mesh = is_closed(join_at_positions(source.mesh));
  Json material = {{"name", text_of_path(file.stem())}};
  material.update(material_of(folder, asset, sky, glb, is_closed_mesh));
  Json prt = {{"version", extension_version},
              {"manifest", parse_json(asset.ranges_file, "kiln-bake or kiln-compress", remedy_for(asset))}};
  if (asset.is_per_vertex()) {
    Json names = Json::object();
    for (const IntegerAttribute& attribute : source.attributes)
      names[attribute.name] = glb_attribute_name(attribute.name);
    prt["attributes"] = std::move(names);
  } else {
    prt["pictures"] = add_planes(folder, asset, glb);
  }
  const std::size_t planes = asset.planes.size();
  glb.use_extension(extension_name, false);
  material["extensions"][extension_name] = std::move(prt);
  material["extras"]["kiln"] = manifest_path(asset.ranges_file, file);
  added.primitive["material"] = glb.add("materials", std::move(material));

  // Step 4: the scene.
  const std::string name = text_of_path(file.stem());
  const std::size_t mesh = glb.add("meshes", {{"name", name}, {"primitives", Json::array({added.primitive})}});
  Json node = {{"name", name}, {"mesh", mesh}};
  if (!asset.origin.isZero(0)) node["translation"] = {asset.origin.x(), asset.origin.y(), asset.origin.z()};
  const std::size_t root = glb.add("nodes", std::move(node));
  glb.json()["scene"] = glb.add("scenes", {{"nodes", Json::array({root})}});

  ExportedAsset result;
  result.glb = glb.bytes();
  result.warnings = left_out(asset);
  result.metrics = {{"vertices", added.vertices},
                    {"triangles", added.triangles},
                    {"planes", planes},
                    {"textures", glb.json().value("textures", Json::array()).size()},
                    {"left_out", result.warnings},
                    {"bytes", result.glb.size()}};
  if (settings.sh1) {
    const SkyPictures pictures = sky_pictures(*sky);
    result.sky_pictures.emplace();
    std::ranges::transform(pictures.pictures, result.sky_pictures->begin(), png_of);
    result.metrics["sh1_clamped_texels"] = pictures.clamped_texels;
    if (pictures.clamped_texels > 0)
      result.warnings.push_back(
          fmt::format("transfer of {} texels exceeds what the pictures of --sh1 can hold, and is clamped there",
                      pictures.clamped_texels));
  }
  return result;
}

}  // namespace kiln
