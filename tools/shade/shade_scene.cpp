// SPDX-License-Identifier: GPL-3.0-or-later
#include "shade/shade_scene.h"

#include <Eigen/Geometry>
#include <numbers>

#include "base/errors.h"
#include "base/numbers.h"
#include "import/uv_mesh.h"
#include "sh/light_spec.h"
#include "yaml/yaml_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Reads the blocks of a scene's file.
class SceneReader {
 public:
  explicit SceneReader(const fs::path& file) : file_(file), folder_(file.parent_path()) {}

  ShadeScene read() {
    const YAML::Node& root = file_.root();
    file_.check_keys(root, {"shaders", "meshes", "nodes", "lights", "background", "picture"});
    for (const char* key : {"shaders", "meshes", "nodes"})
      file_.require(root[key].IsDefined(), root, std::string("no '") + key + "'", "shaders, meshes and nodes");
    read_.shader_folder = folder_ / file_.path(root["shaders"]);
    read_.shaders = read_shaders(read_.shader_folder);
    for (const SurfaceShader& shader : read_.shaders) read_.read_files.push_back(shader.file);
    read_meshes(root["meshes"]);
    file_.require(root["nodes"].IsSequence() && root["nodes"].size() > 0, root["nodes"], "no node", "a list of nodes");
    for (const YAML::Node& node : root["nodes"]) read_node(node);
    if (root["lights"].IsDefined()) read_lights(root["lights"]);
    if (root["background"].IsDefined())
      at(root["background"], [&] {
        read_.scene.background = parse_color("background", file_.scalar(root["background"], "a colour"), 0, 1e6);
      });
    if (root["picture"].IsDefined()) {
      file_.check_keys(root["picture"], {});
      for (const auto& entry : root["picture"])
        read_.picture[entry.first.Scalar()] = file_.scalar(entry.second, "one value");
    }
    return std::move(read_);
  }

 private:
  /// Calls `read`, and turns what it refuses into a fault of the file's line.
  template <class Read>
  void at(const YAML::Node& node, Read read) const {
    try {
      read();
    } catch (const WrongUsage& fault) {
      throw BadInput(file_.where(node), fault.what(), "a value as docs/shaders.md says", "correct it");
    }
  }

  void read_meshes(const YAML::Node& meshes) {
    file_.check_keys(meshes, {});
    for (const auto& entry : meshes) {
      const fs::path path = folder_ / file_.path(entry.second);
      file_.require(fs::exists(path), entry.second, path.string() + ", which does not exist",
                    "a mesh with uvs, or a folder of kiln-bake");
      ShadedMesh mesh;
      if (fs::is_directory(path)) {
        mesh.asset = &read_.assets.emplace_back(load_prt_asset(path));
        mesh.mesh = &mesh.asset->mesh;
      } else {
        mesh.mesh = &read_.meshes.emplace_back(load_uv_mesh(path));
        read_.read_files.push_back(path);
      }
      mesh_numbers_[entry.first.Scalar()] = static_cast<int>(read_.scene.meshes.size());
      read_.scene.meshes.push_back(mesh);
    }
  }

  /// Reads a material of a node; nodes with the same one share it.
  int read_material(const YAML::Node& node) {
    ShadedMaterial material{file_.scalar(node["shader"], "a shader's name")};
    const SurfaceShader* shader = nullptr;
    for (const SurfaceShader& known : read_.shaders)
      if (known.name == material.shader) shader = &known;
    file_.require(shader != nullptr, node["shader"], "the shader '" + material.shader + "'",
                  "a file " + (read_.shader_folder / (material.shader + ".glsl")).string());
    const YAML::Node settings = node["set"];
    if (settings.IsDefined()) file_.check_keys(settings, {});
    for (const auto& entry : settings) {
      const std::string name = entry.first.Scalar();
      const ShaderParameter* parameter = shader->find(name);
      file_.require(parameter != nullptr && parameter->kind == ShaderParameter::Kind::constant, entry.first,
                    "the parameter '" + name + "'", "a parameter that " + shader->file.string() + " declares");
      const auto count = static_cast<std::size_t>(component_count(parameter->type));
      std::vector<double> numbers;
      at(entry.second, [&] {
        numbers = parse_numbers(name, file_.scalar(entry.second, "numbers between commas"),
                                parameter->has_range ? static_cast<double>(parameter->lowest) : -1e9,
                                parameter->has_range ? static_cast<double>(parameter->highest) : 1e9);
      });
      file_.require(numbers.size() == count, entry.second, std::to_string(numbers.size()) + " numbers",
                    std::to_string(count) + ", for a " + glsl_type(parameter->type));
      ShaderValue& value = material.values[name];
      for (std::size_t c = 0; c < count; ++c) value[c] = static_cast<float>(numbers[c]);
    }
    std::vector<ShadedMaterial>& materials = read_.scene.materials;
    for (std::size_t k = 0; k < materials.size(); ++k)
      if (materials[k].shader == material.shader && materials[k].values == material.values) return static_cast<int>(k);
    materials.push_back(std::move(material));
    return static_cast<int>(materials.size()) - 1;
  }

  /// Reads "X,Y,Z,DEGREES": a turn about an axis.
  Eigen::Matrix3d read_turn(const YAML::Node& node) const {
    std::vector<double> numbers;
    at(node, [&] { numbers = parse_numbers("turn", file_.scalar(node, "X,Y,Z,DEGREES"), -1e9, 1e9); });
    const bool is_turn = numbers.size() == 4 && Eigen::Vector3d(numbers.data()).norm() > 0;
    file_.require(is_turn, node, node.Scalar(), "an axis and an angle, X,Y,Z,DEGREES");
    return Eigen::AngleAxisd(numbers[3] * std::numbers::pi / 180, Eigen::Vector3d(numbers.data()).normalized())
        .toRotationMatrix();
  }

  bool read_switch(const YAML::Node& node, bool otherwise) const {
    if (!node.IsDefined()) return otherwise;
    const std::string text = file_.scalar(node, "true or false");
    file_.require(text == "true" || text == "false", node, text, "true or false");
    return text == "true";
  }

  void read_node(const YAML::Node& node) {
    file_.check_keys(node, {"name", "mesh", "shader", "set", "place", "turn", "casts-shadow", "mirror"});
    for (const char* key : {"mesh", "shader"})
      file_.require(node[key].IsDefined(), node, std::string("a node without '") + key + "'", "mesh and shader");
    ShadedNode made;
    const auto mesh = mesh_numbers_.find(file_.scalar(node["mesh"], "a mesh's name"));
    file_.require(mesh != mesh_numbers_.end(), node["mesh"], "the mesh '" + node["mesh"].Scalar() + "'",
                  "one of those under 'meshes'");
    made.mesh = mesh->second;
    made.material = read_material(node);
    if (node["place"].IsDefined())
      at(node["place"],
         [&] { made.placement = parse_placement("place", file_.scalar(node["place"], "X,Y,Z[,AZIMUTH[,SCALE]]")); });
    if (node["turn"].IsDefined()) made.placement.rotation = read_turn(node["turn"]) * made.placement.rotation;
    made.casts_shadow = read_switch(node["casts-shadow"], true);
    if (read_switch(node["mirror"], false)) {
      file_.require(!read_.scene.mirror, node["mirror"], "a second mirror", "at most one");
      read_.scene.mirror = MirrorPlane{static_cast<int>(read_.scene.nodes.size()), made.placement.translation,
                                       made.placement.rotation * Eigen::Vector3d::UnitY()};
    }
    read_.scene.nodes.push_back(made);
  }

  void read_lights(const YAML::Node& lights) {
    file_.require(lights.IsSequence(), lights, "no list", "a list of lights, as kiln-render --light has them");
    for (const YAML::Node& light : lights) {
      read_.lights.push_back(file_.scalar(light, "a light"));
      at(light, [&] { read_.scene.lights.specs.push_back(parse_light_spec(read_.lights.back())); });
    }
  }

  YamlFile file_;
  fs::path folder_;
  ShadeScene read_;
  std::map<std::string, int> mesh_numbers_;
};

}  // namespace

ShadeScene load_shade_scene(const fs::path& file) { return SceneReader(file).read(); }

std::vector<Eigen::Vector3f> placed_shape(const ShadedScene& scene) {
  std::vector<Eigen::Vector3f> shape;
  for (const ShadedNode& node : scene.nodes)
    for (const Eigen::Vector3f& vertex : scene.meshes[static_cast<std::size_t>(node.mesh)].mesh->positions)
      shape.emplace_back(node.placement.to_scene(vertex.cast<double>()).cast<float>());
  return shape;
}

}  // namespace kiln
