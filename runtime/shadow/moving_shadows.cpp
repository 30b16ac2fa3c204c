// SPDX-License-Identifier: MIT
#include "runtime/shadow/moving_shadows.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <optional>
#include <type_traits>
#include <utility>

#include "base/parallel.h"
#include "runtime/shadow/combined_shadows.h"
#include "runtime/shadow/kept_state.h"
#include "runtime/shadow/light_sources.h"
#include "runtime/shadow/receiver_state.h"
#include "runtime/shadow/shadow_field.h"
#include "runtime/shadow/silhouette.h"
#include "runtime/shadow/sphere_set.h"
#include "runtime/shadow/tree_filters.h"
#include "sh/basis.h"
#include "sh/exponential.h"
#include "sh/product.h"
#include "sh/rotation.h"

namespace kiln {

namespace {

using Method = ShadowMethod;

bool passes_down_the_tree(Method method) {
  return method == Method::thesis || method == Method::product || method == Method::subtraction;
}

constexpr std::size_t engine_points = 4096;

/// One point of a node.
struct PointTask {
  int node;
  std::size_t point;
};

/// What a node's siblings block, for receivers of both sorts: all, and static ones.
struct TreeState {
  std::array<StateKey, 2> key;
  std::array<std::vector<BlockedSum>, 2> blocked;  ///< by point; of a composite node at its ball's centre
};

}  // namespace

struct MovingShadows::Implementation {
  SceneTree tree;
  std::vector<ShadowObject> objects;
  ShadowSettings settings;
  std::shared_ptr<VisibilityEngine> engine;  ///< null: rays
  int most_bands = 1;

  // By asset.
  std::vector<BoundingBall> balls;
  std::vector<double> silhouettes;
  std::vector<RayOccluder> rays;
  std::vector<SphereSet> spheres;
  std::vector<ShadowField> fields;
  DirectionSet sky;

  // The lights, and what is made of them when they change.
  std::vector<double> lights_key;
  int lights_version = 0;
  LightSources sources;
  bool is_local = false;

  // By node.
  std::vector<StateKey> keys;            ///< of methods but `combined`
  std::vector<ReceiverState> receivers;  ///< of `combined`
  std::vector<std::vector<LightCoefficients>> light;
  std::vector<NodeOccluders> occluders;
  std::vector<TreeState> tree_states;
  std::vector<PlacedNode> placed;
  ShadowStatistics statistics;

  Implementation(SceneTree of_tree, std::vector<ShadowObject> of_objects, const ShadowSettings& of_settings,
                 std::shared_ptr<VisibilityEngine> of_engine);

  const SceneNode& node_of(int node) const { return tree.nodes[static_cast<std::size_t>(node)]; }
  const ShadowObject& object_of(int node) const { return objects[static_cast<std::size_t>(node_of(node).asset)]; }
  int method_bands(int bands) const {
    return settings.method == Method::product ? std::max(bands, settings.product_bands) : bands;
  }

  void set_tree(SceneTree new_tree);
  void note_lights(const SceneLights& lights);
  std::vector<int> nodes_in_the_way(int node) const;
  /// Returns the points whose light is to be computed, and notes for what they are.
  std::vector<PointTask> find_tasks(const ShadowStage& stage);
  void find_tasks_of(const ShadowStage& stage, int node, std::vector<PointTask>& tasks);
  void update_trees(const ShadowStage& stage);
  BlockedSum blocked_above(int node, std::size_t point, int bands) const;

  ShadowPoint point_of(const ShadowStage& stage, const PointTask& task) const;
  /// Asks the engine what is blocked at some points; empty if rays are cast instead.
  std::optional<VisibilityTable> seen_by_engine(const ShadowStage& stage, std::span<const PointTask> tasks) const;
  LightCoefficients shadowed(const ShadowStage& stage, const SceneLights& lights, const PointTask& task,
                             const ShRotation& into_object, const LightCoefficients& unshadowed,
                             const std::optional<LightCoefficients>& incident, const PointVisibility* known);
  std::vector<float> visibility(const ShadowStage& stage, int node, const Eigen::Vector3d& position, int bands) const;
};

MovingShadows::Implementation::Implementation(SceneTree of_tree, std::vector<ShadowObject> of_objects,
                                              const ShadowSettings& of_settings,
                                              std::shared_ptr<VisibilityEngine> of_engine)
    : tree(std::move(of_tree)), objects(std::move(of_objects)), settings(of_settings), engine(std::move(of_engine)) {
  const std::optional<ThreadLimit> limit = limit_of(settings.threads);
  for (const ShadowObject& object : objects) most_bands = std::max(most_bands, object.bands);
  keys.resize(tree.nodes.size());
  receivers.resize(tree.nodes.size());
  light.resize(tree.nodes.size());
  occluders.resize(tree.nodes.size());
  tree_states.resize(tree.nodes.size());
  if (settings.method == Method::none) return;
  sky = sphere_directions(settings.directions, method_bands(most_bands));
  for (const ShadowObject& object : objects) {
    balls.push_back(bounding_ball(*object.mesh));
    rays.emplace_back(*object.mesh);
    const SilhouetteRays silhouette = cast_silhouettes(rays.back(), balls.back());
    silhouettes.push_back(silhouette_radius(silhouette, balls.back()));
    if (settings.method == Method::exponentiation)
      spheres.push_back(fit_spheres(*object.mesh, silhouette, settings.spheres));
    if (settings.method == Method::fields)
      fields.emplace_back(rays.back(), balls.back(), silhouettes.back(), most_bands);
  }
  if (settings.method != Method::combined) engine.reset();
  if (!engine) return;
  std::vector<const TriangleMesh*> meshes;
  for (const ShadowObject& object : objects) meshes.push_back(object.mesh);
  engine->set_meshes(meshes);
}

void MovingShadows::Implementation::note_lights(const SceneLights& lights) {
  std::vector<double> key = numbers_of(lights);
  if (lights_version > 0 && key == lights_key) return;
  lights_key = std::move(key);
  ++lights_version;
  is_local = lights.is_local();
  if (settings.method == Method::combined) sources = light_sources(lights, most_bands, sky);
  if (engine && !sources.has_probes) engine->set_lights(sources, sky, most_bands);
}

void MovingShadows::Implementation::set_tree(SceneTree new_tree) {
  const SceneTree old = std::exchange(tree, std::move(new_tree));
  const std::vector<int> now = same_nodes(old, tree);
  // Moves what belongs to a node to where the node is now.
  const auto carry = [&](auto& of_nodes) {
    std::remove_reference_t<decltype(of_nodes)> carried(tree.nodes.size());
    for (std::size_t k = 0; k < now.size(); ++k)
      if (now[k] >= 0) carried[static_cast<std::size_t>(now[k])] = std::move(of_nodes[k]);
    of_nodes = std::move(carried);
  };
  carry(keys);
  carry(light);
  carry(receivers);
  carry(tree_states);
  occluders.assign(tree.nodes.size(), {});
  for (ReceiverState& receiver : receivers) receiver.rename(now);
  for (StateKey& key : keys) {
    key.rename(now);
    if (passes_down_the_tree(settings.method)) key = {};  // filters come down another way
  }
  for (TreeState& state : tree_states)
    for (StateKey& key : state.key) key.rename(now);
}

std::vector<int> MovingShadows::Implementation::nodes_in_the_way(int node) const {
  std::vector<int> nodes;
  for (int other = 0; other < tree.count(); ++other)
    if (settings.method != Method::none && node_of(other).asset >= 0 && may_shadow(tree, other, node))
      nodes.push_back(other);
  return nodes;
}

void MovingShadows::Implementation::find_tasks_of(const ShadowStage& stage, int node, std::vector<PointTask>& tasks) {
  constexpr double degree = 0.017453292519943295;
  const auto k = static_cast<std::size_t>(node);
  const std::size_t points = object_of(node).points.size();
  const double unit = settings.method == Method::none ? 1 : std::max(placed[k].ball.radius, 1e-30);
  const auto add_all = [&](std::size_t pairs) {
    statistics.pairs += pairs;
    light[k].resize(points);
    for (std::size_t p = 0; p < points; ++p) tasks.push_back({node, p});
  };
  if (settings.method != Method::combined) {
    const std::vector<int> in_the_way = nodes_in_the_way(node);
    StateKey key = key_of(node, in_the_way, stage.poses, unit, is_local, lights_version);
    if (key.is_same(keys[k]) && light[k].size() == points) return;
    keys[k] = std::move(key);
    add_all(in_the_way.size());
    return;
  }
  occluders[k] = find_occluders(stage, node, sources, settings.cap_degrees * degree);
  const ReceiverState::Change change =
      receivers[k].note(stage, node, key_of(node, {}, stage.poses, unit, is_local, lights_version), unit, occluders[k]);
  if (!engine && !sources.has_probes) receivers[k].keep_layers(points, layer_words(stage, sources));
  const std::size_t pairs = occluders[k].meshes.size() + occluders[k].sky_meshes.size() + occluders[k].sky_caps.size();
  if (change.is_all || light[k].size() != points) return add_all(pairs);
  if (change.balls.empty()) return;
  std::vector<std::uint8_t> may(points);
  parallel_for(std::size_t{0}, points, std::size_t{64}, [&](std::size_t p) {
    const ShadowPoint point = point_of(stage, {node, p});
    may[p] = std::any_of(change.balls.begin(), change.balls.end(),
                         [&](const BoundingBall& ball) { return may_see(point, ball, sources); });
  });
  statistics.pairs += pairs;
  for (std::size_t p = 0; p < points; ++p)
    if (may[p] != 0) tasks.push_back({node, p});
}

std::vector<PointTask> MovingShadows::Implementation::find_tasks(const ShadowStage& stage) {
  statistics = {};
  std::vector<PointTask> tasks;
  std::size_t points = 0;
  for (int node = 0; node < tree.count(); ++node) {
    if (node_of(node).asset < 0) continue;
    points += object_of(node).points.size();
    find_tasks_of(stage, node, tasks);
  }
  statistics.computed = tasks.size();
  statistics.kept = points - tasks.size();
  return tasks;
}

void MovingShadows::Implementation::update_trees(const ShadowStage& stage) {
  struct Job {
    int node;
    std::size_t sort, point;
  };
  std::vector<Job> jobs;
  const std::size_t sorts = placed.front().has_static ? 2 : 1;
  std::vector<std::array<SiblingOccluders, 2>> siblings(tree.nodes.size());
  for (int node = 1; node < tree.count(); ++node) {
    const auto k = static_cast<std::size_t>(node);
    TreeState& state = tree_states[k];
    const bool is_mesh = node_of(node).asset >= 0;
    const std::size_t points = is_mesh ? object_of(node).points.size() : 1;
    for (std::size_t sort = 0; sort < sorts; ++sort) {
      if (is_mesh && node_of(node).is_static != (sort == 1)) continue;
      siblings[k][sort] = sibling_occluders(stage, node, settings.composite_balls, sort == 1);
      const double unit = std::max(placed[k].ball.radius, 1e-30);
      StateKey key = key_of(node, siblings[k][sort].meshes, stage.poses, unit, false, 0);
      // A composite node counts by its ball, whose centre is the point: what moves within it changes nothing.
      std::vector<int> composites = siblings[k][sort].balls;
      if (!is_mesh) composites.push_back(node);
      for (const int composite : composites)
        add_ball(key, composite, placed[static_cast<std::size_t>(composite)].ball, stage.pose_of(node), unit);
      if (key.is_same(state.key[sort]) && state.blocked[sort].size() == points) continue;
      state.key[sort] = std::move(key);
      state.blocked[sort].assign(points, {});
      for (std::size_t p = 0; p < points; ++p) jobs.push_back({node, sort, p});
    }
  }
  parallel_for(std::size_t{0}, jobs.size(), [&](std::size_t j) {
    const auto& [node, sort, point] = jobs[j];
    const auto k = static_cast<std::size_t>(node);
    const Eigen::Vector3d position = node_of(node).asset < 0
                                         ? placed[k].ball.centre
                                         : stage.pose_of(node).to_scene(object_of(node).points[point].cast<double>());
    tree_states[k].blocked[sort][point] = blocked_by(stage, siblings[k][sort], position);
  });
  statistics.computed = jobs.size();
}

BlockedSum MovingShadows::Implementation::blocked_above(int node, std::size_t point, int bands) const {
  const std::size_t sort = node_of(node).is_static ? 1 : 0;
  BlockedSum sum;
  for (int above = node; node_of(above).parent >= 0; above = node_of(above).parent) {
    const TreeState& state = tree_states[static_cast<std::size_t>(above)];
    const BlockedSum& own = state.blocked[sort][above == node ? point : 0];
    if (own.empty()) continue;
    sum.resize(static_cast<std::size_t>(coefficient_count(bands)), 0.0);
    for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += own[i];
  }
  return sum;
}

std::vector<float> MovingShadows::Implementation::visibility(const ShadowStage& stage, int node,
                                                             const Eigen::Vector3d& position, int bands) const {
  const auto coefficients = static_cast<std::size_t>(coefficient_count(bands));
  std::vector<float> all;
  for (const int other : nodes_in_the_way(node)) {
    const auto asset = static_cast<std::size_t>(node_of(other).asset);
    const Placement& pose = stage.pose_of(other);
    if (settings.method == Method::exponentiation) {
      std::vector<BoundingBall> placed_balls;
      for (const BoundingBall& ball : spheres[asset].balls)
        placed_balls.push_back({pose.to_scene(ball.centre), pose.scale * ball.radius});
      const std::vector<float> own = log_visibility(placed_balls, position, bands);
      all.resize(coefficients, 0.f);
      for (std::size_t i = 0; i < coefficients; ++i) all[i] += own[i];
    } else {
      std::vector<float> own = fields[asset].visibility(pose.to_object(position));
      if (pose.turns()) own = ShRotation(most_bands, pose.rotation)(own);
      own.resize(coefficients);
      all = all.empty() ? own : ShProduct::of_bands(bands)(all, own);
    }
  }
  if (settings.method == Method::exponentiation && !all.empty()) all = ShExponential::of_bands(bands)(all);
  return all;
}

ShadowPoint MovingShadows::Implementation::point_of(const ShadowStage& stage, const PointTask& task) const {
  const Placement& pose = stage.pose_of(task.node);
  const ShadowObject& object = object_of(task.node);
  ShadowPoint point{pose.to_scene(object.points[task.point].cast<double>()), std::nullopt};
  if (!object.normals.empty()) point.normal = pose.rotation * object.normals[task.point].cast<double>();
  return point;
}

std::optional<VisibilityTable> MovingShadows::Implementation::seen_by_engine(const ShadowStage& stage,
                                                                             std::span<const PointTask> tasks) const {
  if (!engine || sources.has_probes) return std::nullopt;  // light past probes differs from point to point
  std::vector<ShadowPoint> points;
  for (const PointTask& task : tasks) points.push_back(point_of(stage, task));
  std::vector<VisibilityTask> asked;
  for (std::size_t t = 0; t < tasks.size(); ++t)
    asked.push_back({&points[t], &occluders[static_cast<std::size_t>(tasks[t].node)]});
  return engine->find(stage, sources, asked);
}

LightCoefficients MovingShadows::Implementation::shadowed(const ShadowStage& stage, const SceneLights& lights,
                                                          const PointTask& task, const ShRotation& into_object,
                                                          const LightCoefficients& unshadowed,
                                                          const std::optional<LightCoefficients>& incident,
                                                          const PointVisibility* known) {
  const int bands = object_of(task.node).bands;
  const Placement& pose = stage.pose_of(task.node);
  const Eigen::Vector3d position = pose.to_scene(object_of(task.node).points[task.point].cast<double>());
  const auto turned = [&](const LightCoefficients& in_scene) {
    return pose.turns() ? into_object(in_scene) : in_scene;
  };
  if (settings.method == Method::combined) {
    const NodeOccluders& nodes = occluders[static_cast<std::size_t>(task.node)];
    const std::optional<LightSum> removed =
        removed_light(stage, nodes, lights, sources, most_bands, point_of(stage, task), known,
                      receivers[static_cast<std::size_t>(task.node)].layer(task.point, nodes));
    if (!removed) return unshadowed;
    LightCoefficients taken{bands, {}};
    for (const std::vector<double>& channel : *removed)
      taken.channels.emplace_back(channel.begin(), channel.begin() + coefficient_count(bands));
    return add_lights(unshadowed, scale_light(turned(taken), -1));
  }
  const LightCoefficients arriving = incident ? *incident : lights.incident(bands, position);
  if (!passes_down_the_tree(settings.method)) {
    const std::vector<float> visible = visibility(stage, task.node, position, bands);
    return visible.empty() ? unshadowed : turned(filtered_light(Method::product, arriving, visible));
  }
  const BlockedSum blocked = blocked_above(task.node, task.point, method_bands(bands));
  if (blocked.empty()) return unshadowed;
  const std::vector<float> filter = filter_of(blocked);
  if (method_bands(bands) > bands) return turned(product_of_many_bands(lights, filter, bands, position));
  return turned(filtered_light(settings.method, arriving, filter));
}

MovingShadows::MovingShadows(SceneTree tree, std::vector<ShadowObject> objects, const ShadowSettings& settings,
                             std::shared_ptr<VisibilityEngine> engine)
    : implementation_(
          std::make_unique<Implementation>(std::move(tree), std::move(objects), settings, std::move(engine))) {}
MovingShadows::~MovingShadows() = default;
MovingShadows::MovingShadows(MovingShadows&&) noexcept = default;
MovingShadows& MovingShadows::operator=(MovingShadows&&) noexcept = default;

void MovingShadows::set_tree(SceneTree tree) { implementation_->set_tree(std::move(tree)); }

void MovingShadows::update(const ScenePoses& poses, const SceneLights& lights) {
  Implementation& own = *implementation_;
  assert(poses.size() == own.tree.nodes.size());
  const std::optional<ThreadLimit> limit = limit_of(own.settings.threads);
  own.note_lights(lights);
  if (own.settings.method != Method::none) own.placed = place_nodes(own.tree, own.balls, own.silhouettes, poses);
  const ShadowStage stage{own.tree, poses, own.placed, own.rays, own.sky};
  const std::vector<PointTask> tasks = own.find_tasks(stage);
  if (passes_down_the_tree(own.settings.method)) own.update_trees(stage);

  // Computes what the points of a node share: the turn into its space, and light that is the same everywhere.
  struct NodeLight {
    std::optional<ShRotation> into_object;
    LightCoefficients unshadowed;
    std::optional<LightCoefficients> incident;
  };
  std::vector<NodeLight> of_nodes(own.tree.nodes.size());
  std::vector<std::uint8_t> is_computed(own.tree.nodes.size(), 0);
  for (const PointTask& task : tasks) is_computed[static_cast<std::size_t>(task.node)] = 1;
  parallel_for(0, own.tree.count(), [&](int node) {
    if (is_computed[static_cast<std::size_t>(node)] == 0) return;
    NodeLight& shared = of_nodes[static_cast<std::size_t>(node)];
    const Placement& pose = poses[static_cast<std::size_t>(node)];
    const ShadowObject& object = own.object_of(node);
    shared.into_object.emplace(object.bands, pose.rotation.transpose());
    if (own.is_local) return;
    shared.unshadowed = light_asset(lights, object.bands, pose, std::span(object.points).first(1)).samples.front();
    shared.incident = lights.incident(object.bands, Eigen::Vector3d::Zero());
  });
  const auto compute = [&](std::size_t t, const PointVisibility* known) {
    const PointTask& task = tasks[t];
    const auto k = static_cast<std::size_t>(task.node);
    const NodeLight& shared = of_nodes[k];
    const ShadowObject& object = own.object_of(task.node);
    const LightCoefficients unshadowed =
        own.is_local ? light_asset(lights, object.bands, poses[k], std::span(object.points).subspan(task.point, 1))
                           .samples.front()
                     : shared.unshadowed;
    own.light[k][task.point] =
        own.settings.method == Method::none
            ? unshadowed
            : own.shadowed(stage, lights, task, *shared.into_object, unshadowed, shared.incident, known);
  };
  // An engine is asked for some thousands of points at a time, which bounds what it says of them.
  const std::size_t together = own.engine ? engine_points : std::max<std::size_t>(1, tasks.size());
  for (std::size_t first = 0; first < tasks.size(); first += together) {
    const std::span<const PointTask> part = std::span(tasks).subspan(first, std::min(together, tasks.size() - first));
    const std::optional<VisibilityTable> seen = own.seen_by_engine(stage, part);
    parallel_for(std::size_t{0}, part.size(), [&](std::size_t t) {
      if (!seen) return compute(first + t, nullptr);
      const PointVisibility known = seen->at(t);
      compute(first + t, &known);
    });
  }
}

std::span<const LightCoefficients> MovingShadows::light_of(int node) const {
  return implementation_->light[static_cast<std::size_t>(node)];
}

const ShadowStatistics& MovingShadows::statistics() const { return implementation_->statistics; }

double MovingShadows::sphere_mismatch(int asset) const {
  return implementation_->spheres.empty() ? 0 : implementation_->spheres[static_cast<std::size_t>(asset)].mismatch;
}

}  // namespace kiln
