// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Core>
#include <memory>
#include <optional>
#include <string_view>
#include <vector>

#include "asset/prt_asset.h"
#include "runtime/light/incident_samples.h"
#include "runtime/light/scene_lights.h"
#include "runtime/scene/cluster_tree.h"
#include "runtime/scene/scene_description.h"
#include "runtime/shadow/moving_shadows.h"

namespace kiln {

struct MovingSceneSettings {
  ShadowSettings shadows = {};
  int incident_samples = most_incident_samples;   ///< as for place_incident_samples
  std::shared_ptr<VisibilityEngine> engine = {};  ///< in place of rays; null: rays
  /// Whether light() leaves out lights with a direction (is_direct), for renderers that draw shadow maps of these.
  bool without_direct = false;
};

/// A scene at a time: where its nodes are, and the light that each of them receives.
class MovingScene {
 public:
  /// `assets` and `meshes` are those of the description, in its order; they must live on. Throws WrongUsage for a
  /// description that is none (names and parents, motions), and BadInput for its environment.
  MovingScene(SceneDescription scene, std::vector<const PrtAsset*> assets, const MovingSceneSettings& settings,
              std::vector<const TriangleMesh*> meshes = {});

  const SceneDescription& description() const { return scene_; }
  int item_count() const { return static_cast<int>(scene_.items.size()); }
  const SceneItem& item(int item) const { return scene_.items[static_cast<std::size_t>(item)]; }
  const PrtAsset& asset_of(int item) const { return *assets_[static_cast<std::size_t>(this->item(item).asset)]; }
  /// Returns the mesh of an item, with or without transfer; null for a composite node.
  const TriangleMesh* mesh_of(int item) const;
  /// Returns the index of the item of that name, or -1.
  int find(std::string_view name) const;

  /// Makes light a sum of functions, with a light vector for each of the description's lights (SceneLights::vectors),
  /// whose radiance is grey at all times: lights() and light() have a channel for each function then. Shadows are
  /// computed for three functions at a time. Throws WrongUsage for more than three beside an engine, and for an
  /// environment.
  void set_light_vectors(std::vector<Eigen::VectorXf> vectors);

  /// Sets the time, seconds. Nothing is computed before it is asked for.
  void set_time(double time);
  double time() const { return time_; }

  /// Moves an item, with all in it, from where its motion has it; by a vector of the scene's space, added to earlier
  /// ones. Throws WrongUsage for a static item, or one in which one stands, whose shadow is in the bakes of others.
  void move(int item, const Eigen::Vector3d& by);
  /// Takes all such moves back.
  void put_back();

  const Placement& pose(int item);
  const SceneLights& lights();
  /// Returns the light of an item with an asset, at its incident-light samples, without what others shadow; meshes
  /// without transfer shadow nothing.
  AssetLight light(int item);
  /// Returns the points at which light() has it, object space.
  const std::vector<Eigen::Vector3f>& points(int item) const;

  /// Returns what finds shadows in place of rays, or null.
  const VisibilityEngine* shadow_engine() const { return settings_.engine.get(); }

  /// Computes the light of all items, if anything has changed since it was computed; light() does so as well.
  void update();
  /// Tells what the last computation of light did; of the first three functions.
  const ShadowStatistics& statistics() const { return shadows_.front().statistics(); }

  /// Returns the tree that shadows go by.
  const SceneTree& tree();
  /// Returns how often a tree that is found has changed.
  int tree_changes() const { return tree_changes_; }

 private:
  void place();
  std::vector<NodeSphere> spheres() const;
  std::vector<Eigen::Vector3f> normals_at(std::size_t asset) const;
  ScenePoses tree_poses() const;
  SceneLights transferred_lights(std::size_t functions) const;
  void make_shadows();
  int node_of(int item) const;

  SceneDescription scene_;
  std::vector<const PrtAsset*> assets_;
  std::vector<const TriangleMesh*> meshes_;
  MovingSceneSettings settings_;
  std::vector<std::vector<Eigen::Vector3f>> points_;  ///< by asset
  std::vector<NodeSphere> asset_spheres_;             ///< object space
  std::vector<Eigen::Vector3d> moved_;                ///< by item, in its parent's space
  std::vector<int> leaves_;                           ///< items with an asset
  double time_ = 0;
  bool is_placed_ = false, is_lit_ = false;
  std::vector<Placement> poses_;
  SceneLights lights_;
  SceneTree given_tree_;
  std::optional<ClusterTree> found_tree_;
  int tree_changes_ = 0;
  std::vector<MovingShadows> shadows_;  ///< one for each three functions of light; made when light is first computed
};

}  // namespace kiln
