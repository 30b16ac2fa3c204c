// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade_scene.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "import/uv_mesh.h"
#include "runtime/scene_file/scene_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Returns a value for a parameter of a shader. Throws BadInput at its line.
ShaderValue value_of(const SceneParameter& given, const SurfaceShader& shader) {
  const auto require = [&](bool good, const std::string& found, const std::string& expected) {
    if (!good) throw BadInput(given.where, found, expected, "correct it");
  };
  const ShaderParameter* parameter = shader.find(given.name);
  const bool is_known = parameter != nullptr && parameter->kind == ShaderParameter::Kind::constant;
  require(is_known, "the parameter '" + given.name + "'", "a parameter that " + shader.file.string() + " declares");
  const auto count = static_cast<std::size_t>(component_count(parameter->type));
  require(given.numbers.size() == count, fmt::format("{} numbers for {}", given.numbers.size(), given.name),
          fmt::format("{}, for a {}", count, glsl_type(parameter->type)));
  ShaderValue value = {};
  for (std::size_t c = 0; c < count; ++c) {
    value[c] = static_cast<float>(given.numbers[c]);
    const bool is_inside = !parameter->has_range || (value[c] >= parameter->lowest && value[c] <= parameter->highest);
    require(is_inside, fmt::format("{} for {}", given.numbers[c], given.name),
            fmt::format("{} to {}", parameter->lowest, parameter->highest));
    const bool is_whole = parameter->type != ShaderType::integer || value[c] == std::round(value[c]);
    require(is_whole, fmt::format("{} for {}", given.numbers[c], given.name), "a whole number");
  }
  return value;
}

/// Returns what a node's surface is made of, of these shaders.
ShadedMaterial material_of(const SceneItem& item, const SceneDescription& scene,
                           const std::vector<SurfaceShader>& shaders) {
  ShadedMaterial material{item.surface.shader};
  const auto shader = std::find_if(shaders.begin(), shaders.end(),
                                   [&](const SurfaceShader& known) { return known.name == material.shader; });
  if (shader == shaders.end())
    throw BadInput(item.where,
                   "node '" + item.name + "' " +
                       (material.shader.empty() ? "without a shader" : "with the shader '" + material.shader + "'"),
                   material.shader.empty() ? "'shader', the name of one of " + (scene.shaders / "*.glsl").string()
                                           : "a file " + (scene.shaders / (material.shader + ".glsl")).string(),
                   "name another shader, or write it");
  for (const SceneParameter& given : item.surface.parameters) material.values[given.name] = value_of(given, *shader);
  return material;
}

/// Returns the number of a material; nodes with the same one share it.
int number_of(ShadedMaterial material, std::vector<ShadedMaterial>& materials) {
  const auto same = std::find_if(materials.begin(), materials.end(), [&](const ShadedMaterial& other) {
    return other.shader == material.shader && other.values == material.values;
  });
  const auto number = static_cast<int>(same - materials.begin());
  if (same == materials.end()) materials.push_back(std::move(material));
  return number;
}

void add_nodes(ShadeScene& read) {
  const SceneDescription& description = read.film.description;
  for (std::size_t k = 0; k < description.items.size(); ++k) {
    const SceneItem& item = description.items[k];
    if (item.is_composite()) continue;
    ShadedNode node;
    node.mesh = item.asset >= 0 ? item.asset : static_cast<int>(description.assets.size()) + item.mesh;
    node.material = number_of(material_of(item, description, read.shaders), read.scene.materials);
    node.casts_shadow = item.surface.casts_shadow;
    if (item.surface.is_mirror) read.scene.mirror = MirrorPlane{static_cast<int>(read.scene.nodes.size())};
    read.scene.nodes.push_back(node);
    read.items.push_back(static_cast<int>(k));
  }
}

void load_meshes(ShadeScene& read) {
  const SceneDescription& description = read.film.description;
  for (const fs::path& folder : description.assets) read.film.assets.push_back(load_prt_asset(folder));
  for (const SceneItem& item : description.items)
    if (item.asset >= 0 && !has_shadable_planes(read.film.assets[static_cast<std::size_t>(item.asset)]))
      throw BadInput(item.where, "node '" + item.name + "' with transfer at vertices or in several clusters",
                     "an asset with planes, plain or of one cluster, for shaders of one's own",
                     "name a folder of kiln-bake with planes");
  for (const fs::path& file : description.meshes) read.meshes.push_back(load_uv_mesh(file));
  for (const PrtAsset& asset : read.film.assets) read.scene.meshes.push_back({&asset.mesh, &asset});
  for (const TriangleMesh& mesh : read.meshes) read.scene.meshes.push_back({&mesh, nullptr});
}

}  // namespace

MovingScene ShadeScene::moving(const MovingSceneSettings& settings) const {
  std::vector<const TriangleMesh*> pointers;
  for (const TriangleMesh& mesh : meshes) pointers.push_back(&mesh);
  return {film.description, film.asset_pointers(), settings, pointers};
}

std::vector<SurfaceShader> ShadeScene::shaders_again() const {
  std::vector<SurfaceShader> read = read_shaders(film.description.shaders);
  for (const int item : items)
    material_of(film.description.items[static_cast<std::size_t>(item)], film.description, read);
  return read;
}

std::vector<fs::path> ShadeScene::shader_folders() const {
  std::set<fs::path> folders = {film.description.shaders};
  for (const SurfaceShader& shader : shaders)
    for (const ShaderParameter& parameter : shader.parameters)
      if (parameter.kind == ShaderParameter::Kind::texture)
        folders.insert((shader.file.parent_path() / parameter.picture).lexically_normal().parent_path());
  return {folders.begin(), folders.end()};
}

std::vector<fs::path> ShadeScene::read_files() const {
  std::vector<fs::path> files = film.description.meshes;
  for (const SurfaceShader& shader : shaders) files.push_back(shader.file);
  return files;
}

ShadeScene load_shade_scene(const fs::path& file) {
  ShadeScene read;
  read.file = file;
  read.film.description = load_scene(file);
  if (read.film.description.shaders.empty())
    throw BadInput(file.string(), "a scene without 'shaders'", "'shaders', a folder of NAME.glsl",
                   "add it, and 'shader' to each node; or draw the scene by kiln-render, which needs none");
  require_no_lamps(read.film.description,
                   "leave 'lamp' out, or draw the scene by kiln-render or by kiln-view --by transfer");
  read.shaders = read_shaders(read.film.description.shaders);
  add_nodes(read);
  load_meshes(read);
  MovingScene moving = read.moving({.incident_samples = 1});
  const std::vector<Placement> placements = placements_now(read, moving);
  for (std::size_t k = 0; k < placements.size(); ++k) read.scene.nodes[k].placement = placements[k];
  read.scene.lights = moving.lights();
  read.scene.background = read.film.description.background.value_or(read.scene.background);
  return read;
}

std::string note_of_albedo(const ShadeScene& scene) {
  for (const int number : scene.items) {
    const SceneItem& item = scene.film.description.items[static_cast<std::size_t>(number)];
    if (item.asset >= 0 && scene.film.assets[static_cast<std::size_t>(item.asset)].albedo.within_transfer)
      return item.where + ": the transfer of node '" + item.name +
             "' includes its albedo, so that light.diffuse is coloured; a shader that multiplies it by a colour has "
             "both";
  }
  return "";
}

std::vector<Placement> placements_now(const ShadeScene& scene, MovingScene& moving) {
  std::vector<Placement> placements;
  for (const int item : scene.items) placements.push_back(moving.pose(item));
  return placements;
}

}  // namespace kiln
