// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "kiln/asset.h"

// Needs kiln::runtime-scene, which brings libraries that kiln::runtime does without.
namespace kiln::runtime {

/// In place of a number of points: light is computed at every vertex of each mesh.
inline constexpr int light_at_vertices = -1;

struct SceneSettings {
  std::string shadows = {};      ///< method, as for kiln-render --shadows; empty: that of kiln-render
  int shadow_directions = 1024;  ///< in which a point looks for what shadows it
  int light_points = 8;          ///< around each asset, 1 to 8, or light_at_vertices
  int threads = 0;               ///< 0: all
};

/// Place of a node within its parent: scaled, turned, then moved.
struct Pose {
  std::array<double, 3> translation = {0, 0, 0};
  std::array<double, 3> axis = {0, 1, 0};  ///< of any length but 0
  double degrees = 0;                      ///< turn about the axis, right-handed
  double scale = 1;                        ///< above 0
};

/// Pose at a time. Between two of them translation and scale change linearly, and the turn along the shorter arc.
struct PoseKeyframe {
  double time = 0;  ///< seconds
  Pose pose = {};
};

class Scene;

/// A scene put together in code. Nodes are numbered from 0 in the order in which they are added; a parent of -1 is the
/// scene itself. Functions throw Error for what no scene is.
class KILN_RUNTIME_API SceneBuilder {
 public:
  SceneBuilder();
  SceneBuilder(SceneBuilder&&) noexcept;
  SceneBuilder& operator=(SceneBuilder&&) noexcept;
  ~SceneBuilder();

  /// Adds a node that others stand in; returns its number.
  int add_group(std::string_view name, const Pose& pose = {}, int parent = -1);
  /// Adds a node with an asset; `is_static` if its bake and those of the other static nodes have each other's shadow.
  int add_asset(std::string_view name, const Asset& asset, const Pose& pose = {}, int parent = -1,
                bool is_static = false);
  /// Adds a light, written as for kiln-render --light.
  SceneBuilder& add_light(std::string_view text);
  /// Moves a node by keyframes, in the order of time.
  SceneBuilder& animate(int node, const std::vector<PoseKeyframe>& keyframes);
  /// Moves a node on a circle around its pose, in `period` seconds; from +Z towards +X about +Y.
  SceneBuilder& orbit(int node, const std::array<double, 3>& axis, double radius, double period);
  /// Groups nodes for shadows by how near and large they are, in place of by the groups that were added.
  SceneBuilder& find_tree();

 private:
  friend class Scene;
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Assets that move, shadow each other, and are lit: where each is at a time, and the light that it receives there.
/// What is asked for is computed when it is asked for; so not even constant functions may be called from two threads at
/// once.
class KILN_RUNTIME_API Scene {
 public:
  /// Reads a scene.yaml (docs/scenes.md) and its assets. What it says of shaders of one's own (`shader`, `set`,
  /// `casts-shadow`, `mirror`) and `background` have no effect here. Throws Error, also for nodes with a `mesh`.
  static Scene load(const std::filesystem::path& file, const SceneSettings& settings = {});
  explicit Scene(const SceneBuilder& builder, const SceneSettings& settings = {});
  Scene(Scene&&) noexcept;
  Scene& operator=(Scene&&) noexcept;
  ~Scene();

  int node_count() const;
  std::string name(int node) const;
  int parent(int node) const;  ///< -1: the scene itself
  /// Returns the number of the node of that name, or -1.
  int find(std::string_view name) const;
  bool has_asset(int node) const;
  /// Throws Error for a node without one.
  const Asset& asset(int node) const;

  double duration() const;  ///< seconds; 0 if nothing moves
  void set_time(double seconds);
  /// Moves a node, with all in it, from where its motion has it, by a vector of the scene's space; adds to earlier
  /// moves. Throws Error for a static node.
  void move(int node, const std::array<double, 3>& by);

  /// Returns the matrix from a node's space to the scene's, for column vectors, column after column.
  std::array<float, 16> scene_from_object(int node) const;

  /// Returns the number of points at which a node's light is computed, and where they are: three numbers each, object
  /// space.
  std::size_t light_point_count(int node) const;
  std::vector<float> light_points(int node) const;
  /// Returns the light at those points, without what other nodes shadow, in the node's own space: for each point
  /// bands^2 numbers of red, then of green, then of blue. exit_radiance and gl::Renderer take it.
  std::vector<float> light(int node) const;

 private:
  struct Implementation;
  explicit Scene(std::unique_ptr<Implementation> implementation);
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace kiln::runtime
