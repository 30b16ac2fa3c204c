// SPDX-License-Identifier: MIT
#include "kiln/scene.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "api/report_errors.h"
#include "asset/prt_asset.h"
#include "runtime/play/moving_scene.h"
#include "runtime/scene_file/scene_file.h"

namespace kiln::runtime {

namespace {

Eigen::Vector3d unit_axis(const std::array<double, 3>& axis) {
  const Eigen::Vector3d along(axis.data());
  if (!(along.norm() > 0) || !along.allFinite()) throw Error("scene: found an axis of length 0; expected a direction");
  return along.normalized();
}

Eigen::Quaterniond turn_of(const Pose& pose) {
  return Eigen::Quaterniond(Eigen::AngleAxisd(pose.degrees * std::numbers::pi / 180, unit_axis(pose.axis)));
}

void check(const Pose& pose) {
  if (!(pose.scale > 0) || !std::isfinite(pose.scale))
    throw Error("scene: found a scale of " + std::to_string(pose.scale) + "; expected one above 0");
  if (!Eigen::Vector3d(pose.translation.data()).allFinite() || !std::isfinite(pose.degrees))
    throw Error("scene: found a pose with a number that is none");
}

Placement placement_of(const Pose& pose) {
  check(pose);
  return {turn_of(pose).toRotationMatrix(), pose.scale, Eigen::Vector3d(pose.translation.data())};
}

MovingSceneSettings settings_of(const SceneSettings& given) {
  MovingSceneSettings settings;
  settings.incident_samples = given.light_points;
  if (given.light_points != light_at_vertices && (given.light_points < 1 || given.light_points > most_incident_samples))
    throw Error("SceneSettings: found " + std::to_string(given.light_points) +
                " light_points; expected 1 to 8, or light_at_vertices");
  if (given.shadow_directions < 1) throw Error("SceneSettings: found no shadow_directions; expected 1 or more");
  settings.shadows.directions = given.shadow_directions;
  settings.shadows.threads = given.threads;
  if (given.shadows.empty()) return settings;
  const auto found = std::find(shadow_method_names.begin(), shadow_method_names.end(), given.shadows);
  if (found == shadow_method_names.end())
    throw Error("SceneSettings: found shadows '" + given.shadows + "'; expected a method of kiln-render --shadows");
  settings.shadows.method = static_cast<ShadowMethod>(found - shadow_method_names.begin());
  return settings;
}

}  // namespace

struct SceneBuilder::Implementation {
  SceneDescription description;
  std::vector<Asset> assets;

  SceneItem& item(int node) {
    if (node < 0 || node >= static_cast<int>(description.items.size()))
      throw Error("SceneBuilder: found node " + std::to_string(node) + "; expected one that was added");
    return description.items[static_cast<std::size_t>(node)];
  }

  int add(std::string_view name, const Pose& pose, int parent, int asset, bool is_static) {
    if (parent != -1 && item(parent).asset >= 0)
      throw Error("SceneBuilder: found an asset as a parent; expected a group");
    SceneItem added;
    added.name = name;
    added.parent = parent;
    added.asset = asset;
    added.is_static = is_static;
    added.rest = placement_of(pose);
    description.items.push_back(added);
    return static_cast<int>(description.items.size()) - 1;
  }
};

SceneBuilder::SceneBuilder() : implementation_(std::make_unique<Implementation>()) {}
SceneBuilder::SceneBuilder(SceneBuilder&&) noexcept = default;
SceneBuilder& SceneBuilder::operator=(SceneBuilder&&) noexcept = default;
SceneBuilder::~SceneBuilder() = default;

int SceneBuilder::add_group(std::string_view name, const Pose& pose, int parent) {
  return implementation_->add(name, pose, parent, -1, false);
}

int SceneBuilder::add_asset(std::string_view name, const Asset& asset, const Pose& pose, int parent, bool is_static) {
  std::vector<Asset>& assets = implementation_->assets;
  const auto found = std::find_if(assets.begin(), assets.end(), [&](const Asset& other) {
    return &other.implementation() == &asset.implementation();
  });
  const auto number = static_cast<int>(found - assets.begin());
  const int node = implementation_->add(name, pose, parent, number, is_static);
  if (number == static_cast<int>(assets.size())) {
    assets.push_back(asset);
    implementation_->description.assets.emplace_back();
  }
  return node;
}

SceneBuilder& SceneBuilder::add_light(std::string_view text) {
  report_errors([&] { implementation_->description.lights.push_back({parse_light_spec(text), {}}); });
  return *this;
}

SceneBuilder& SceneBuilder::animate(int node, const std::vector<PoseKeyframe>& keyframes) {
  Keyframes motion;
  for (const PoseKeyframe& keyframe : keyframes) {
    check(keyframe.pose);
    motion.frames.push_back({keyframe.time, Eigen::Vector3d(keyframe.pose.translation.data()), turn_of(keyframe.pose),
                             keyframe.pose.scale});
  }
  report_errors([&] { check_motion(motion); });
  implementation_->item(node).motion = motion;
  return *this;
}

SceneBuilder& SceneBuilder::orbit(int node, const std::array<double, 3>& axis, double radius, double period) {
  CircularOrbit motion;
  motion.axis = unit_axis(axis);
  motion.radius = radius;
  motion.period = period;
  report_errors([&] { check_motion(motion); });
  implementation_->item(node).motion = motion;
  return *this;
}

SceneBuilder& SceneBuilder::find_tree() {
  implementation_->description.tree = TreeChoice::found;
  return *this;
}

struct Scene::Implementation {
  Implementation(SceneDescription description, std::vector<Asset> given, const SceneSettings& settings)
      : assets(std::move(given)), moving(std::move(description), pointers(), settings_of(settings)) {}

  std::vector<const PrtAsset*> pointers() const {
    std::vector<const PrtAsset*> all;
    for (const Asset& asset : assets) all.push_back(&asset.implementation());
    return all;
  }

  /// Returns the number of a node, if there is one.
  int node(int number) const {
    if (number < 0 || number >= moving.item_count())
      throw Error("Scene: found node " + std::to_string(number) + "; expected 0 to " +
                  std::to_string(moving.item_count() - 1));
    return number;
  }

  /// Returns the number of a node with an asset.
  int node_with_asset(int number) const {
    if (moving.item(node(number)).asset < 0)
      throw Error("Scene: found node '" + moving.item(number).name + "', a group; expected one with an asset");
    return number;
  }

  std::vector<Asset> assets;
  MovingScene moving;
};

Scene::Scene(std::unique_ptr<Implementation> implementation) : implementation_(std::move(implementation)) {}

Scene Scene::load(const std::filesystem::path& file, const SceneSettings& settings) {
  return report_errors([&] {
    SceneDescription description = load_scene(file);
    require_transfer(description);
    require_no_lamps(description, "leave 'lamp' out, or draw the scene by kiln-render or kiln-view");
    std::vector<Asset> assets;
    for (const std::filesystem::path& folder : description.assets) assets.push_back(Asset::load(folder));
    return Scene(std::make_unique<Implementation>(std::move(description), std::move(assets), settings));
  });
}

Scene::Scene(const SceneBuilder& builder, const SceneSettings& settings)
    : implementation_(report_errors([&] {
        return std::make_unique<Implementation>(builder.implementation_->description, builder.implementation_->assets,
                                                settings);
      })) {}
Scene::Scene(Scene&&) noexcept = default;
Scene& Scene::operator=(Scene&&) noexcept = default;
Scene::~Scene() = default;

int Scene::node_count() const { return implementation_->moving.item_count(); }
std::string Scene::name(int node) const { return implementation_->moving.item(implementation_->node(node)).name; }
int Scene::parent(int node) const { return implementation_->moving.item(implementation_->node(node)).parent; }
int Scene::find(std::string_view name) const { return implementation_->moving.find(name); }
bool Scene::has_asset(int node) const { return implementation_->moving.item(implementation_->node(node)).asset >= 0; }

const Asset& Scene::asset(int node) const {
  const int item = implementation_->node_with_asset(node);
  return implementation_->assets[static_cast<std::size_t>(implementation_->moving.item(item).asset)];
}

double Scene::duration() const { return duration_of(implementation_->moving.description()); }

void Scene::set_time(double seconds) {
  if (!std::isfinite(seconds)) throw Error("Scene::set_time: found a time that is no number; expected seconds");
  implementation_->moving.set_time(seconds);
}

void Scene::move(int node, const std::array<double, 3>& by) {
  const Eigen::Vector3d vector(by.data());
  if (!vector.allFinite()) throw Error("Scene::move: found a vector with a number that is none");
  report_errors([&] { implementation_->moving.move(implementation_->node(node), vector); });
}

std::array<float, 16> Scene::scene_from_object(int node) const {
  const Eigen::Matrix4f matrix = implementation_->moving.pose(implementation_->node(node)).matrix().cast<float>();
  std::array<float, 16> numbers = {};
  std::copy_n(matrix.data(), numbers.size(), numbers.begin());
  return numbers;
}

std::size_t Scene::light_point_count(int node) const {
  return implementation_->moving.points(implementation_->node_with_asset(node)).size();
}

std::vector<float> Scene::light_points(int node) const {
  std::vector<float> numbers;
  for (const Eigen::Vector3f& point : implementation_->moving.points(implementation_->node_with_asset(node)))
    numbers.insert(numbers.end(), point.data(), point.data() + 3);
  return numbers;
}

std::vector<float> Scene::light(int node) const {
  return report_errors([&] {
    std::vector<float> numbers;
    for (const LightCoefficients& sample :
         implementation_->moving.light(implementation_->node_with_asset(node)).samples)
      for (const std::vector<float>& channel : sample.channels)
        numbers.insert(numbers.end(), channel.begin(), channel.end());
    return numbers;
  });
}

}  // namespace kiln::runtime
