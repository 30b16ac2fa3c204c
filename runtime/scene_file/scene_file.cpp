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
    file_.check_keys(root, {"nodes", "lights", "window", "camera", "tree", "duration"});
    file_.require(root["nodes"].IsDefined(), root, "no 'nodes'", "'nodes', a list with an asset or nodes for each");
    add_nodes(root["nodes"], -1, false, false);
    add_lights(root["lights"]);
    if (root["window"]) scene_.window = window(root["window"]);
    if (root["camera"]) read_camera(root["camera"]);
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
    file_.check_keys(node, {"name", "asset", "nodes", "translate", "rotate", "scale", "animate", "static"});
    file_.require(scene_.items.size() < most_items, node, "more than 10000 nodes", "fewer");
    SceneItem item;
    item.parent = parent;
    file_.require(node["name"].IsDefined(), node, "a node without a name", "'name', which no other node has");
    item.name = file_.scalar(node["name"], "a name");
    const auto [other, is_new] = lines_.emplace(item.name, file_.where(node["name"]));
    file_.require(is_new, node["name"], "the name '" + item.name + "', which " + other->second + " has as well",
                  "a name for each node");
    const bool has_asset = node["asset"].IsDefined(), has_nodes = node["nodes"].IsDefined();
    file_.require(has_asset || has_nodes, node, "node '" + item.name + "' without an asset and without nodes",
                  "one of the two");
    file_.require(!has_asset || !has_nodes, node, "node '" + item.name + "' with both an asset and nodes",
                  "one of the two: an asset may be a node of its own beneath");
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
    if (has_asset) item.asset = asset(node["asset"]);
    scene_.items.push_back(item);
    if (has_nodes) add_nodes(node["nodes"], static_cast<int>(scene_.items.size()) - 1, item.is_static, moves);
  }

  /// Returns the number of an asset's folder, each of which is there once.
  int asset(const YAML::Node& node) {
    const fs::path written = file_.path(node), folder = (folder_of(file_.file()) / written).lexically_normal();
    std::error_code error;
    file_.require(fs::is_directory(folder, error), node,
                  "asset '" + written.string() + "', where no folder is (" + folder.string() + ")",
                  "an output folder of kiln-bake or kiln-compress, which `kiln build` makes");
    const auto found = std::find(scene_.assets.begin(), scene_.assets.end(), folder);
    if (found != scene_.assets.end()) return static_cast<int>(found - scene_.assets.begin());
    scene_.assets.push_back(folder);
    return static_cast<int>(scene_.assets.size()) - 1;
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

  void read_camera(const YAML::Node& node) {
    file_.check_keys(node, {"azimuth", "elevation", "field-of-view", "target", "distance", "zoom"});
    SceneCamera& camera = scene_.camera;
    if (node["azimuth"]) camera.azimuth_degrees = values_.number(node["azimuth"], -360, 360);
    if (node["elevation"]) camera.elevation_degrees = values_.number(node["elevation"], -90, 90);
    if (node["field-of-view"]) camera.field_of_view_degrees = values_.number(node["field-of-view"], 1, 120);
    if (node["target"]) camera.target = values_.place(node["target"]);
    if (node["distance"]) camera.distance = values_.above_zero(node["distance"]);
    if (node["zoom"]) camera.zoom = values_.above_zero(node["zoom"]);
  }

  void read_tree(const YAML::Node& node) {
    const bool is_flat =
        std::all_of(scene_.items.begin(), scene_.items.end(), [](const SceneItem& item) { return item.asset >= 0; });
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

}  // namespace kiln
