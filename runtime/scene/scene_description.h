// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "mesh/placement.h"
#include "runtime/scene/motion.h"
#include "sh/light_spec.h"
#include "sh/windows.h"

namespace kiln {

/// Node of a scene as a person describes it: one with an asset, or one that has others in it.
struct SceneItem {
  std::string name;
  int parent = -1;         ///< index of an item before it; -1: stands in the scene itself
  int asset = -1;          ///< index among the scene's assets; -1: a composite node
  bool is_static = false;  ///< whether the bakes of the other static nodes have its shadow
  Placement rest;          ///< within its parent
  Motion motion;
};

/// Moment of a light.
struct LightKeyframe {
  double time = 0;                               ///< seconds
  std::optional<Eigen::Vector3d> place;          ///< of a ball its centre; of others azimuth, elevation (degrees), 0
  std::optional<std::array<float, 3>> radiance;  ///< LightSpec::color
};

/// Moments of a light, in the order of time, interpolated linearly: also azimuth and elevation, degrees.
struct LightKeyframes {
  std::vector<LightKeyframe> frames;
  MotionEnds ends = MotionEnds::hold;
};

/// A light that may move. On a circle a ball goes around its place; the direction of any other light turns about the
/// axis, and the radius does not matter.
struct SceneLight {
  LightSpec spec;  ///< at rest
  std::variant<std::monostate, LightKeyframes, CircularOrbit> motion;
};

/// A camera as a scene states it; what it leaves out is up to the program.
struct SceneCamera {
  std::optional<double> azimuth_degrees, elevation_degrees, field_of_view_degrees, distance, zoom;
  std::optional<Eigen::Vector3d> target;
};

/// How the nodes are grouped for shadows.
enum class TreeChoice {
  given,  ///< by the scene's own composite nodes
  found,  ///< by how near and how large they are (cluster_tree.h)
};

/// A scene: nodes, each behind its parent, lights, and a camera.
struct SceneDescription {
  std::vector<SceneItem> items;
  std::vector<std::filesystem::path> assets;  ///< folders
  std::vector<SceneLight> lights;
  std::filesystem::path environment;  ///< empty: none
  double environment_rotation_degrees = 0;
  LightWindow window = LightWindow::hann;
  SceneCamera camera;
  TreeChoice tree = TreeChoice::given;
  std::optional<double> duration;  ///< seconds; nothing: that of the longest motion
};

/// Returns the seconds that the scene's film takes; 0 where nothing moves.
double duration_of(const SceneDescription& scene);

/// Returns a light at a time.
LightSpec light_at(const SceneLight& light, double time);

}  // namespace kiln
