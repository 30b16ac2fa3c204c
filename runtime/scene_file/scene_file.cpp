// SPDX-License-Identifier: MIT
#include "runtime/scene_file/scene_file.h"

#include <algorithm>
#include <map>

#include "base/errors.h"
#include "base/files.h"
#include "runtime/scene_file/scene_values.h"
#include "yaml/yaml_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

// Bounds what aliases, which YAML copies, may make of a short file.
constexpr std::size_t most_items = 10000, deepest_item = 100;

class SceneReader {
 public:
  explicit SceneReader(const fs::path& path) : file_(path), values_(file_) {}

  SceneDescription read() {
    const YAML::Node& root = file_.root();
    file_.require(root.IsMap() && root.size() > 0, root, "no scene", "a mapping with 'nodes'");
    file_.check_keys(root,
                     {"nodes", "lights", "window", "camera", "cameras", "background", "shaders", "tree", "duration"});
    file_.require(root["nodes"].IsDefined(), root, "no 'nodes'",
                  "'nodes', a list with an asset, a mesh or nodes for each");
    if (root["shaders"])
      scene_.shaders = existing(root["shaders"], "shaders", true, "a folder of shaders of your own, NAME.glsl");
    add_nodes(root["nodes"], -1, false, false);
    add_lights(root["lights"]);
    if (root["window"]) scene_.window = window(root["window"]);
    if (root["camera"]) scene_.cameras = {values_.camera(root["camera"], false)};
    if (root["cameras"]) {
      file_.require(!root["camera"].IsDefined(), root["cameras"], "both 'camera' and 'cameras'",
                    "one of the two: 'cameras' have names");
      read_cameras(root["cameras"]);
    }
    if (root["background"]) scene_.background = values_.color(root["background"]);
    if (root["duration"]) scene_.duration = values_.above_zero(root["duration"]);
    read_tree(root["tree"]);
    return std::move(scene_);
  }

 private:
  void add_nodes(const YAML::Node& list, int parent, bool is_static, bool moves) {
    file_.require(list.IsSequence() && list.size() > 0, list, "no nodes", "a list of nodes, at least one");
    file_.require(std::none_of(above_.begin(), above_.end(), [&](const YAML::Node& other) { return other.is(list); }),
                  list, "nodes that have themselves in them", "a tree");
    file_.require(above_.size() < deepest_item, list, "more than 100 nodes in one another", "a tree that is less deep");
    above_.push_back(list);
    for (const YAML::Node& node : list) add_node(node, parent, is_static, moves);
    above_.pop_back();
  }

  void add_node(const YAML::Node& node, int parent, bool is_static, bool moves) {
    file_.check_keys(node, {"name", "asset", "mesh", "nodes", "translate", "rotate", "scale", "animate", "static",
                            "shader", "set", "casts-shadow", "mirror"});
    file_.require(scene_.items.size() < most_items, node, "more than 10000 nodes", "fewer");
    SceneItem item;
    item.parent = parent;
    item.where = file_.where(node);
    file_.require(node["name"].IsDefined(), node, "a node without a name", "'name', which no other node has");
    item.name = file_.scalar(node["name"], "a name");
    const auto [other, is_new] = lines_.emplace(item.name, file_.where(node["name"]));
    file_.require(is_new, node["name"], "the name '" + item.name + "', which " + other->second + " has as well",
                  "a name for each node");
    const std::string kind = kind_of(node, item.name);
    if (node["translate"]) item.rest.translation = values_.place(node["translate"]);
    if (node["rotate"]) item.rest.rotation = values_.rotation(node["rotate"]).toRotationMatrix();
    if (node["scale"]) item.rest.scale = values_.scale(node["scale"]);
    if (node["animate"]) item.motion = values_.motion(node["animate"]);
    if (node["static"]) {
      item.is_static = values_.yes_or_no(node["static"]);
      file_.require(item.is_static || !is_static, node["static"], "'false' beneath a static node", "true, or nothing");
    }
    item.is_static = item.is_static || is_static;
    moves = moves || node["animate"].IsDefined();
    file_.require(!item.is_static || !moves, node,
                  "static node '" + item.name + "', which is animated, or stands in a node that is",
                  "a node that stands still, since its shadow is baked into others");
    if (kind == "asset")
      item.asset = number_of(scene_.assets, existing(node["asset"], "asset", true,
                                                     "an output folder of kiln-bake or kiln-compress, which `kiln "
                                                     "build` makes"));
    if (kind == "mesh") item.mesh = number_of(scene_.meshes, existing(node["mesh"], "mesh", false, "a mesh with uvs"));
    read_surface(node, item);
    scene_.items.push_back(item);
    if (kind == "nodes") add_nodes(node["nodes"], static_cast<int>(scene_.items.size()) - 1, item.is_static, moves);
  }

  /// Returns which of the three a node has: an asset, a mesh, or nodes.
  std::string kind_of(const YAML::Node& node, const std::string& name) const {
    std::string kind;
    for (const char* key : {"asset", "mesh", "nodes"}) {
      if (!node[key].IsDefined()) continue;
      file_.require(kind.empty(), node, "node '" + name + "' with both " + kind + " and " + key,
                    "one of the two: each may be a node of its own beneath");
      kind = key;
    }
    file_.require(!kind.empty(), node, "node '" + name + "' without an asset, a mesh or nodes", "one of the three");
    return kind;
  }

  /// Returns a folder or file that a value names.
  fs::path existing(const YAML::Node& node, const std::string& what, bool is_folder,
                    const std::string& expected) const {
    const fs::path written = file_.path(node), path = (folder_of(file_.file()) / written).lexically_normal();
    std::error_code error;
    file_.require(is_folder ? fs::is_directory(path, error) : fs::is_regular_file(path, error), node,
                  what + " '" + written.string() + "', where no " + (is_folder ? "folder" : "file") + " is (" +
                      path.string() + ")",
                  expected);
    return path;
  }

  /// Returns the place of a path in a list that has each once.
  static int number_of(std::vector<fs::path>& paths, const fs::path& path) {
    const auto found = std::find(paths.begin(), paths.end(), path);
    const auto number = static_cast<int>(found - paths.begin());
    if (found == paths.end()) paths.push_back(path);
    return number;
  }

  /// Reads what shaders of one's own are told of a node.
  void read_surface(const YAML::Node& node, SceneItem& item) {
    SceneSurface& surface = item.surface;
    if (item.is_composite())
      for (const char* key : {"shader", "set", "casts-shadow", "mirror"})
        file_.require(!node[key].IsDefined(), node[key].IsDefined() ? node[key] : node,
                      "'" + std::string(key) + "' of node '" + item.name + "', which has other nodes",
                      "it at those of them that are drawn");
    if (node["shader"]) {
      surface.shader = file_.scalar(node["shader"], "a shader's name");
      file_.require(!scene_.shaders.empty(), node["shader"], "a shader in a scene without 'shaders'",
                    "'shaders' of the scene, a folder of NAME.glsl");
    }
    if (node["set"]) {
      file_.require(!surface.shader.empty(), node["set"], "'set' without 'shader'",
                    "the shader whose parameters it sets");
      file_.check_keys(node["set"], {});
      for (const auto& entry : node["set"])
        surface.parameters.push_back(
            {entry.first.Scalar(), values_.components(entry.second), file_.where(entry.second)});
    }
    if (node["casts-shadow"]) surface.casts_shadow = values_.yes_or_no(node["casts-shadow"]);
    if (!node["mirror"]) return;
    surface.is_mirror = values_.yes_or_no(node["mirror"]);
    const bool has_other = std::any_of(scene_.items.begin(), scene_.items.end(),
                                       [](const SceneItem& other) { return other.surface.is_mirror; });
    file_.require(!surface.is_mirror || !has_other, node["mirror"], "a second mirror", "one at most");
  }

  void add_lights(const YAML::Node& list) {
    if (!list.IsDefined()) {
      scene_.lights.emplace_back();  // kiln-render's own, 45, 30
      return;
    }
    file_.require(list.IsSequence() && list.size() > 0, list, "no lights", "a list of lights, at least one");
    for (const YAML::Node& node : list)
      if (node.IsMap() && node["environment"].IsDefined())
        read_environment(node);
      else
        scene_.lights.push_back(values_.light(node));
    const auto has_lamp = [](const YAML::Node& node) { return node["lamp"].IsDefined(); };
    if (std::none_of(list.begin(), list.end(), has_lamp)) return;
    for (const YAML::Node& node : list)
      file_.require(has_lamp(node), node,
                    node["environment"].IsDefined()
                        ? "an environment, which is red, green and blue, beside lights with a 'lamp'"
                        : "a light without a 'lamp' beside lights with one",
                    "'lamp' of all lights, or of none");
  }

  void read_environment(const YAML::Node& node) {
    file_.check_keys(node, {"environment", "rotation"});
    file_.require(scene_.environment.empty(), node, "a second environment", "one");
    scene_.environment = (folder_of(file_.file()) / file_.path(node["environment"])).lexically_normal();
    std::error_code error;
    file_.require(fs::exists(scene_.environment, error), node["environment"],
                  "environment '" + scene_.environment.string() + "', which does not exist",
                  "a picture of radiance, or a folder of six");
    if (node["rotation"]) scene_.environment_rotation_degrees = values_.number(node["rotation"], -360, 360);
  }

  LightWindow window(const YAML::Node& node) const {
    static const std::map<std::string, LightWindow> words = {{"hann", LightWindow::hann},
                                                             {"lanczos", LightWindow::lanczos},
                                                             {"dering", LightWindow::dering},
                                                             {"none", LightWindow::none}};
    const std::string word = file_.scalar(node, "hann, lanczos, dering or none");
    const auto found = words.find(word);
    file_.require(found != words.end(), node, "'" + word + "'", "hann, lanczos, dering or none");
    return found->second;
  }

  void read_cameras(const YAML::Node& list) {
    file_.require(list.IsSequence() && list.size() > 0, list, "no cameras", "a list of cameras, at least one");
    scene_.cameras.clear();
    for (const YAML::Node& node : list) {
      SceneCamera camera = values_.camera(node, true);
      file_.require(!camera.name.empty() && find_camera(scene_, camera.name) < 0, node,
                    "the name '" + camera.name + "' for a second camera, or an empty one", "a name for each camera");
      scene_.cameras.push_back(std::move(camera));
    }
  }

  void read_tree(const YAML::Node& node) {
    const bool is_flat = std::none_of(scene_.items.begin(), scene_.items.end(),
                                      [](const SceneItem& item) { return item.is_composite(); });
    scene_.tree = is_flat ? TreeChoice::found : TreeChoice::given;
    if (!node.IsDefined()) return;
    const std::string word = file_.scalar(node, "given or auto");
    file_.require(word == "given" || word == "auto", node, "'" + word + "'", "given or auto");
    scene_.tree = word == "auto" ? TreeChoice::found : TreeChoice::given;
  }

  YamlFile file_;
  SceneValues values_;
  SceneDescription scene_;
  std::map<std::string, std::string> lines_;  ///< of names
  std::vector<YAML::Node> above_;             ///< lists of nodes around the one that is read
};

}  // namespace

SceneDescription load_scene(const fs::path& file) { return SceneReader(file).read(); }

void require_transfer(const SceneDescription& scene) {
  for (const SceneItem& item : scene.items)
    if (item.mesh >= 0)
      throw BadInput(item.where, "node '" + item.name + "' with a mesh, which has no transfer",
                     "'asset', an output folder of kiln-bake or kiln-compress",
                     "bake the mesh, or draw the scene by kiln-shade, whose shaders need no transfer");
}

void require_no_lamps(const SceneDescription& scene, const std::string& remedy) {
  for (const SceneLight& light : scene.lights)
    if (!light.lamp.empty())
      throw BadInput(light.where, "the lamp '" + light.lamp + "', where light is red, green and blue",
                     "lights without 'lamp'", remedy);
}

}  // namespace kiln
