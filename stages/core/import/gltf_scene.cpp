// SPDX-License-Identifier: GPL-3.0-or-later
#include "import/gltf_scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <map>
#include <optional>

// Scenes and nodes: [Khronos 2021], chapter 3.5; skins: chapter 3.7.3 (a skinned mesh is placed by its joints alone,
// not by its node). Instances: EXT_mesh_gpu_instancing.

namespace kiln {

namespace {

constexpr std::size_t no_node = ~std::size_t{0};
constexpr std::size_t most_weights = 4096;  // every node may have its own

/// Composes translation, rotation (a quaternion x, y, z, w of any length) and scale; absent ones are empty.
Eigen::Matrix4d composed(const std::vector<double>& translation, const std::vector<double>& rotation,
                         const std::vector<double>& scale) {
  Eigen::Affine3d result = Eigen::Affine3d::Identity();
  if (!translation.empty()) result.translate(Eigen::Vector3d(translation[0], translation[1], translation[2]));
  if (!rotation.empty()) {
    const Eigen::Quaterniond turn(rotation[3], rotation[0], rotation[1], rotation[2]);
    if (turn.norm() > 0) result.rotate(turn.normalized());
  }
  if (!scale.empty()) result.scale(Eigen::Vector3d(scale[0], scale[1], scale[2]));
  return result.matrix();
}

class SceneReader {
 public:
  SceneReader(const GltfDocument& document, GltfBuffers& buffers) : document_(document), buffers_(buffers) {}

  std::vector<GltfPlacement> read(std::vector<std::string>& warnings) {
    read_nodes();
    const std::vector<std::size_t> roots = scene_roots(warnings);
    compute_worlds();
    walk(roots);
    const bool has_placed_meshes =
        std::any_of(nodes_.begin(), nodes_.end(), [](const Node& node) { return node.mesh != no_node; });
    if (!has_placed_meshes) {
      for (std::size_t mesh = 0; mesh < document_.count("meshes"); ++mesh) place(mesh, Eigen::Matrix4d::Identity(), {});
      if (!placements_.empty()) warnings.emplace_back("No node places a mesh, so all meshes are read as they are");
    }
    if (skinned_ > 0)
      warnings.push_back(std::to_string(skinned_) + (skinned_ == 1 ? " skinned mesh" : " skinned meshes") +
                         " taken as the skeleton rests in the file, before any animation");
    return std::move(placements_);
  }

 private:
  struct Node {
    Eigen::Matrix4d local = Eigen::Matrix4d::Identity(), world = Eigen::Matrix4d::Identity();
    std::vector<std::size_t> children;
    std::size_t parent = no_node, mesh = no_node, skin = no_node;
    std::vector<double> weights;
  };

  static std::string name_of(std::size_t node) { return "node " + std::to_string(node); }

  void read_nodes() {
    nodes_.resize(document_.count("nodes"));
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const GltfJson& object = document_.element("nodes", i, "the file");
      const std::string place = name_of(i);
      Node& node = nodes_[i];
      const std::vector<double> matrix = document_.numbers(object, "matrix", 16, place);
      node.local = matrix.empty() ? composed(document_.numbers(object, "translation", 3, place),
                                             document_.numbers(object, "rotation", 4, place),
                                             document_.numbers(object, "scale", 3, place))
                                  : Eigen::Matrix4d(Eigen::Map<const Eigen::Matrix4d>(matrix.data()));
      node.mesh = document_.index(object, "mesh", place).value_or(no_node);
      node.skin = document_.index(object, "skin", place).value_or(no_node);
      node.weights = document_.numbers(object, "weights", 0, place);
      node.children = document_.indices(object, "children", place);
      if (node.mesh != no_node) document_.element("meshes", node.mesh, place);
    }
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      for (const std::size_t child : nodes_[i].children) {
        document_.element("nodes", child, name_of(i));
        if (nodes_[child].parent != no_node)
          document_.fail(name_of(child) + " is a child of " + name_of(nodes_[child].parent) + " and of " + name_of(i),
                         "nodes of one parent each");
        nodes_[child].parent = i;
      }
  }

  std::vector<std::size_t> all_roots() const {
    std::vector<std::size_t> roots;
    for (std::size_t i = 0; i < nodes_.size(); ++i)
      if (nodes_[i].parent == no_node) roots.push_back(i);
    return roots;
  }

  std::vector<std::size_t> scene_roots(std::vector<std::string>& warnings) const {
    const std::size_t scenes = document_.count("scenes");
    const auto given = document_.index(document_.root_object(), "scene", "the file");
    if (scenes == 0 && !given) return all_roots();
    const std::size_t scene = given.value_or(0);
    const std::string place = "scene " + std::to_string(scene);
    if (scenes > 1)
      warnings.push_back("The file has " + std::to_string(scenes) + " scenes, of which scene " + std::to_string(scene) +
                         " is read");
    std::vector<std::size_t> roots = document_.indices(document_.element("scenes", scene, "the file"), "nodes", place);
    for (const std::size_t root : roots) {
      document_.element("nodes", root, place);
      if (nodes_[root].parent != no_node)
        document_.fail(place + " names " + name_of(root) + ", which is a child of " + name_of(nodes_[root].parent),
                       "nodes without a parent");
    }
    std::sort(roots.begin(), roots.end());
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
    return roots;
  }

  /// Calls `visit` for nodes beneath `roots`, parents before children. Works without recursion, for any depth.
  template <class Visit>
  void for_each(const std::vector<std::size_t>& roots, const Visit& visit) const {
    std::vector<std::size_t> left(roots.rbegin(), roots.rend());
    while (!left.empty()) {
      const std::size_t node = left.back();
      left.pop_back();
      visit(node);
      left.insert(left.end(), nodes_[node].children.rbegin(), nodes_[node].children.rend());
    }
  }

  void compute_worlds() {
    std::vector<bool> is_reached(nodes_.size(), false);
    for_each(all_roots(), [&](std::size_t i) {
      Node& node = nodes_[i];
      is_reached[i] = true;
      node.world = node.parent == no_node ? node.local : Eigen::Matrix4d(nodes_[node.parent].world * node.local);
    });
    // Every node has one parent, so nodes that no root reaches form a ring.
    const auto ring = std::find(is_reached.begin(), is_reached.end(), false);
    if (ring != is_reached.end())
      document_.fail(name_of(static_cast<std::size_t>(ring - is_reached.begin())) + " is beneath itself",
                     "nodes that form a tree");
  }

  void walk(const std::vector<std::size_t>& roots) {
    for_each(roots, [this](std::size_t i) {
      const Node& node = nodes_[i];
      if (node.mesh == no_node) return;
      const std::string place_name = name_of(i);
      const GltfJson& object = document_.element("nodes", i, "the file");
      const std::string name = given_name(object);
      if (node.skin != no_node) {
        place(node.mesh, node.world, node.weights, name);
        placements_.back().joints = joints(node.skin, place_name);
        ++skinned_;
        return;
      }
      const GltfJson* instancing = document_.extension(object, "EXT_mesh_gpu_instancing", place_name);
      if (instancing == nullptr)
        place(node.mesh, node.world, node.weights, name);
      else
        for (const Eigen::Matrix4d& instance : instances(*instancing, place_name))
          place(node.mesh, node.world * instance, node.weights, name);
    });
  }

  static std::string given_name(const GltfJson& object) {
    const auto name = object.find("name");
    return name != object.end() && name->is_string() ? name->get<std::string>() : std::string();
  }

  void place(std::size_t mesh, const Eigen::Matrix4d& world, std::vector<double> weights, std::string name = {}) {
    const GltfJson& object = document_.element("meshes", mesh, "a node");
    if (name.empty()) name = given_name(object);
    if (weights.empty()) weights = document_.numbers(object, "weights", 0, "mesh " + std::to_string(mesh));
    if (weights.size() > most_weights)
      document_.fail("mesh " + std::to_string(mesh) + " has " + std::to_string(weights.size()) + " morph weights",
                     "at most " + std::to_string(most_weights));
    if (std::all_of(weights.begin(), weights.end(), [](double weight) { return weight == 0; })) weights.clear();
    placements_.push_back({mesh, world, std::move(weights), std::move(name), nullptr});
  }

  using Joints = std::shared_ptr<const std::vector<Eigen::Matrix4d>>;

  Joints joints(std::size_t skin, const std::string& user) {
    Joints& known = joints_[skin];
    if (known == nullptr) known = std::make_shared<const std::vector<Eigen::Matrix4d>>(read_joints(skin, user));
    return known;
  }

  std::vector<Eigen::Matrix4d> read_joints(std::size_t skin, const std::string& user) {
    const std::string place_name = "skin " + std::to_string(skin);
    const GltfJson& object = document_.element("skins", skin, user);
    std::vector<Eigen::Matrix4d> result;
    for (const std::size_t joint : document_.indices(object, "joints", place_name)) {
      document_.element("nodes", joint, place_name);
      result.push_back(nodes_[joint].world);
    }
    const auto index = document_.index(object, "inverseBindMatrices", place_name);
    if (!index) return result;
    const GltfAccessor inverse = buffers_.accessor(*index, place_name);
    if (inverse.components != 16 || inverse.count < result.size())
      document_.fail(place_name + " has " + std::to_string(result.size()) + " joints and " +
                         std::to_string(inverse.count) + " inverse bind matrices",
                     "one MAT4 for each joint");
    for (std::size_t i = 0; i < result.size(); ++i) {
      Eigen::Matrix4d matrix;
      for (int k = 0; k < 16; ++k) matrix(k % 4, k / 4) = inverse.value(i, k);
      result[i] = result[i] * matrix;
    }
    return result;
  }

  std::vector<Eigen::Matrix4d> instances(const GltfJson& instancing, const std::string& place_name) {
    const std::string where = place_name + " (EXT_mesh_gpu_instancing)";
    const GltfJson* attributes = document_.object(instancing, "attributes", where);
    if (attributes == nullptr) document_.fail(where + " has no attributes", "TRANSLATION, ROTATION or SCALE");
    std::optional<std::size_t> count;
    const auto read = [&](const char* name, int components) {
      std::optional<GltfAccessor> accessor;
      if (const auto index = document_.index(*attributes, name, where)) accessor = buffers_.accessor(*index, where);
      if (!accessor) return accessor;
      if (accessor->components != components || count.value_or(accessor->count) != accessor->count ||
          accessor->count > buffers_.total_bytes())
        document_.fail(where + " has a " + name + " of " + std::to_string(accessor->count) + " elements of " +
                           std::to_string(accessor->components) + " numbers",
                       "as many as the other attributes have, of " + std::to_string(components) + " numbers");
      count = accessor->count;
      return accessor;
    };
    const auto translations = read("TRANSLATION", 3);
    const auto rotations = read("ROTATION", 4);
    const auto scales = read("SCALE", 3);
    const auto numbers = [](const std::optional<GltfAccessor>& accessor, std::size_t i) {
      std::vector<double> values;
      for (int k = 0; accessor && k < accessor->components; ++k) values.push_back(accessor->value(i, k));
      return values;
    };
    std::vector<Eigen::Matrix4d> result;
    for (std::size_t i = 0; i < count.value_or(0); ++i)
      result.push_back(composed(numbers(translations, i), numbers(rotations, i), numbers(scales, i)));
    return result;
  }

  const GltfDocument& document_;
  GltfBuffers& buffers_;
  std::vector<Node> nodes_;
  std::vector<GltfPlacement> placements_;
  std::map<std::size_t, Joints> joints_;
  std::size_t skinned_ = 0;
};

}  // namespace

std::vector<GltfPlacement> place_gltf_meshes(const GltfDocument& document, GltfBuffers& buffers,
                                             std::vector<std::string>& warnings) {
  return SceneReader(document, buffers).read(warnings);
}

}  // namespace kiln
