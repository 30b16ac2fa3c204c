// SPDX-License-Identifier: MIT
#include "runtime/play/moving_scene.h"

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>

#include "base/errors.h"
#include "runtime/light/environment.h"

namespace kiln {

namespace {

/// Functions of light that shadows are computed for at once: in place of red, green and blue.
constexpr std::size_t functions_at_once = 3;

/// Returns the sphere around a mesh whose centre is that of its box.
NodeSphere sphere_around(const TriangleMesh& mesh) {
  NodeSphere sphere{bounding_box(mesh).centre().cast<double>(), 0};
  for (const Eigen::Vector3f& vertex : mesh.positions)
    sphere.radius = std::max(sphere.radius, (vertex.cast<double>() - sphere.centre).norm());
  return sphere;
}

void check_items(const SceneDescription& scene, std::size_t assets, std::size_t meshes) {
  const auto require = [](bool good, const std::string& message) {
    if (!good) throw WrongUsage(message);
  };
  std::set<std::string> names;
  for (std::size_t k = 0; k < scene.items.size(); ++k) {
    const SceneItem& item = scene.items[k];
    require(names.insert(item.name).second, "scene: found the name '" + item.name + "' twice; expected one for each");
    require(item.parent < static_cast<int>(k), "scene: found '" + item.name + "' before its parent");
    require(item.asset < static_cast<int>(assets), "scene: found an asset that is not there, of '" + item.name + "'");
    require(item.mesh < static_cast<int>(meshes), "scene: found a mesh that is not there, of '" + item.name + "'");
    require(item.asset < 0 || item.mesh < 0, "scene: found '" + item.name + "' with an asset and a mesh");
    require(item.parent < 0 || scene.items[static_cast<std::size_t>(item.parent)].is_composite(),
            "scene: found '" + item.name + "' in a node with an asset or a mesh; expected one without");
    require(item.rest.scale > 0, "scene: found a scale of 0 or below, of '" + item.name + "'");
    check_motion(item.motion);
  }
}

}  // namespace

MovingScene::MovingScene(SceneDescription scene, std::vector<const PrtAsset*> assets,
                         const MovingSceneSettings& settings, std::vector<const TriangleMesh*> meshes)
    : scene_(std::move(scene)),
      assets_(std::move(assets)),
      meshes_(std::move(meshes)),
      settings_(settings),
      moved_(scene_.items.size()) {
  check_items(scene_, assets_.size(), meshes_.size());
  int bands = 3;  // at least, for shading without harmonics
  for (const PrtAsset* asset : assets_) {
    points_.push_back(place_incident_samples(asset->mesh, settings.incident_samples).points);
    asset_spheres_.push_back(sphere_around(asset->mesh));
    bands = std::max(bands, asset->bands);
  }
  put_back();
  lights_.window = scene_.window;
  if (!scene_.environment.empty())
    lights_.environment = load_environment(scene_.environment, bands, scene_.environment_rotation_degrees);
  given_tree_.nodes.assign(1, {});
  given_tree_.nodes[0].name = "root";
  std::vector<SceneNode> leaves;
  for (std::size_t k = 0; k < scene_.items.size(); ++k) {
    const SceneItem& item = scene_.items[k];
    const int parent = item.parent + 1;  // the root is the tree's first node
    given_tree_.nodes.push_back({item.name, parent, {}, item.asset, item.is_static});
    given_tree_.nodes[static_cast<std::size_t>(parent)].children.push_back(static_cast<int>(k) + 1);
    if (item.asset < 0) continue;
    leaves_.push_back(static_cast<int>(k));
    leaves.push_back({item.name, -1, {}, item.asset, item.is_static});
  }
  if (scene_.tree == TreeChoice::found) found_tree_.emplace(std::move(leaves));
}

const TriangleMesh* MovingScene::mesh_of(int item) const {
  const SceneItem& asked = this->item(item);
  if (asked.asset >= 0) return &asset_of(item).mesh;
  return asked.mesh >= 0 ? meshes_[static_cast<std::size_t>(asked.mesh)] : nullptr;
}

int MovingScene::find(std::string_view name) const {
  for (std::size_t k = 0; k < scene_.items.size(); ++k)
    if (scene_.items[k].name == name) return static_cast<int>(k);
  return -1;
}

void MovingScene::set_light_vectors(std::vector<Eigen::VectorXf> vectors) {
  if (!vectors.empty() && vectors.size() != scene_.lights.size())
    throw std::invalid_argument("MovingScene: there must be a light vector for each light");
  if (!vectors.empty() && lights_.environment)
    throw WrongUsage("scene: found an environment, which is red, green and blue, with lamps; expected lights alone");
  if (settings_.engine && !vectors.empty() && static_cast<std::size_t>(vectors.front().size()) > functions_at_once)
    throw WrongUsage("shadow-backend: found gpu with " + std::to_string(vectors.front().size()) +
                     " different lamps; expected at most 3, or backend rays");
  lights_.vectors = std::move(vectors);
  shadows_.clear();
  is_lit_ = false;
}

void MovingScene::set_time(double time) {
  if (time == time_) return;
  time_ = time;
  is_placed_ = is_lit_ = false;
}

void MovingScene::move(int item, const Eigen::Vector3d& by) {
  for (int k = 0; k < item_count(); ++k) {
    int above = k;
    while (above >= 0 && above != item) above = this->item(above).parent;
    if (above == item && this->item(k).is_static)
      throw WrongUsage("node '" + this->item(item).name + "' is static: its shadow is in the bakes of others");
  }
  const int parent = this->item(item).parent;
  const Placement outer = parent < 0 ? Placement{} : pose(parent);
  moved_[static_cast<std::size_t>(item)] += outer.rotation.transpose() * by / outer.scale;
  is_placed_ = is_lit_ = false;
}

void MovingScene::put_back() {
  std::fill(moved_.begin(), moved_.end(), Eigen::Vector3d::Zero());
  is_placed_ = is_lit_ = false;
}

void MovingScene::place() {
  if (is_placed_) return;
  poses_.resize(scene_.items.size());
  for (std::size_t k = 0; k < scene_.items.size(); ++k) {
    const SceneItem& item = scene_.items[k];
    Placement place = place_at(item.rest, item.motion, time_);
    place.translation += moved_[k];
    poses_[k] = item.parent < 0 ? place : compose(poses_[static_cast<std::size_t>(item.parent)], place);
  }
  lights_.specs.clear();
  for (const SceneLight& light : scene_.lights) lights_.specs.push_back(light_at(light, time_));
  is_placed_ = true;
}

std::vector<NodeSphere> MovingScene::spheres() const {
  std::vector<NodeSphere> spheres;
  for (const int leaf : leaves_) {
    const auto k = static_cast<std::size_t>(leaf);
    const NodeSphere& own = asset_spheres_[static_cast<std::size_t>(scene_.items[k].asset)];
    spheres.push_back({poses_[k].to_scene(own.centre), poses_[k].scale * own.radius});
  }
  return spheres;
}

int MovingScene::node_of(int item) const {
  if (!found_tree_) return item + 1;
  return found_tree_->node_of(
      static_cast<int>(std::lower_bound(leaves_.begin(), leaves_.end(), item) - leaves_.begin()));
}

ScenePoses MovingScene::tree_poses() const {
  ScenePoses poses(static_cast<std::size_t>((found_tree_ ? found_tree_->tree() : given_tree_).count()));
  for (std::size_t k = 0; k < scene_.items.size(); ++k)
    if (!found_tree_ || scene_.items[k].asset >= 0)
      poses[static_cast<std::size_t>(node_of(static_cast<int>(k)))] = poses_[k];
  return poses;
}

void MovingScene::update() {
  place();
  if (is_lit_) return;
  if (found_tree_ && found_tree_->update(spheres())) {
    if (!shadows_.empty()) ++tree_changes_;
    for (MovingShadows& shadows : shadows_) shadows.set_tree(found_tree_->tree());
  }
  if (shadows_.empty()) make_shadows();
  for (std::size_t k = 0; k < shadows_.size(); ++k)
    shadows_[k].update(tree_poses(), transferred_lights(functions_at_once * k));
  is_lit_ = true;
}

void MovingScene::make_shadows() {
  for (std::size_t first = 0; first < lights_.channels(); first += functions_at_once) {
    std::vector<ShadowObject> objects;
    for (std::size_t k = 0; k < assets_.size(); ++k)
      objects.push_back({&assets_[k]->mesh, points_[k], assets_[k]->bands, normals_at(k)});
    shadows_.emplace_back(found_tree_ ? found_tree_->tree() : given_tree_, std::move(objects), settings_.shadows,
                          settings_.engine);
  }
}

/// Returns the normals of an asset's points, where these are its vertices.
std::vector<Eigen::Vector3f> MovingScene::normals_at(std::size_t asset) const {
  const bool has_normals = assets_[asset]->mesh.normals.size() == points_[asset].size();
  if (settings_.incident_samples != samples_at_vertices || !has_normals) return {};
  return assets_[asset]->mesh.normals;
}

const Placement& MovingScene::pose(int item) {
  place();
  return poses_[static_cast<std::size_t>(item)];
}

const SceneLights& MovingScene::lights() {
  place();
  return lights_;
}

/// Returns the lights whose red, green and blue are functions from `functions` on, if light is a sum of these: light
/// and shadow are linear in radiance. Of one function all three are alike, which is computed once.
SceneLights MovingScene::transferred_lights(std::size_t functions) const {
  SceneLights lights = lights_;
  lights.vectors.clear();
  for (std::size_t k = 0; k < lights_.vectors.size(); ++k) {
    const Eigen::VectorXf& vector = lights_.vectors[k];
    const auto count = static_cast<std::size_t>(vector.size());
    for (std::array<float, 3>* const color : {&lights.specs[k].color, &lights.specs[k].ground})
      for (std::size_t c = 0; c < 3; ++c) {
        const std::size_t function = count == 1 ? 0 : functions + c;
        (*color)[c] *= function < count ? vector[static_cast<Eigen::Index>(function)] : 0;
      }
  }
  if (settings_.without_direct) std::erase_if(lights.specs, [](const LightSpec& spec) { return is_direct(spec); });
  return lights;
}

AssetLight MovingScene::light(int item) {
  update();
  AssetLight light = light_asset(lights_, asset_of(item).bands, pose(item), {});
  const std::span<const LightCoefficients> samples = shadows_.front().light_of(node_of(item));
  light.samples.assign(samples.begin(), samples.end());
  for (std::size_t k = 1; k < shadows_.size(); ++k) {
    const std::span<const LightCoefficients> more = shadows_[k].light_of(node_of(item));
    for (std::size_t s = 0; s < more.size(); ++s)
      light.samples[s].channels.insert(light.samples[s].channels.end(), more[s].channels.begin(),
                                       more[s].channels.end());
  }
  for (LightCoefficients& sample : light.samples) sample.channels.resize(lights_.channels());
  return light;
}

const std::vector<Eigen::Vector3f>& MovingScene::points(int item) const {
  return points_[static_cast<std::size_t>(scene_.items[static_cast<std::size_t>(item)].asset)];
}

const SceneTree& MovingScene::tree() {
  place();
  if (!found_tree_) return given_tree_;
  if (found_tree_->update(spheres())) {
    for (MovingShadows& shadows : shadows_) shadows.set_tree(found_tree_->tree());
    is_lit_ = false;
  }
  return found_tree_->tree();
}

}  // namespace kiln
