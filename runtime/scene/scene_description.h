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

/// Value of a shader's parameter, as a scene states it.
struct SceneParameter {
  std::string name;
  std::vector<double> numbers;  ///< one to four
  std::string where = {};       ///< "FILE:LINE"
};

/// How shaders of one's own draw a node (docs/shaders.md); nothing else looks at it.
struct SceneSurface {
  std::string shader;  ///< empty: none
  std::vector<SceneParameter> parameters;
  bool casts_shadow = true;
  bool is_mirror = false;  ///< the plane through its origin, across its Y; of one node at most
};

/// Node of a scene as a person describes it: one with an asset, one with a mesh, or one that has others in it.
struct SceneItem {
  std::string name;
  int parent = -1;         ///< index of an item before it; -1: stands in the scene itself
  int asset = -1;          ///< index among the scene's assets; -1: none
  int mesh = -1;           ///< index among the scene's meshes, which have no transfer; -1: none
  bool is_static = false;  ///< whether the bakes of the other static nodes have its shadow
  Placement rest;          ///< within its parent
  Motion motion;
  SceneSurface surface;
  std::string where;  ///< "FILE:LINE"; empty for one from code

  bool is_composite() const { return asset < 0 && mesh < 0; }
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
  std::string lamp = {};   ///< a spectrum by name, or a file relative to the scene's folder; empty: RGB
  std::string where = {};  ///< "FILE:LINE"; empty for one from code
};

/// What a camera is told, at rest or at one moment; what it leaves out is up to the program.
struct CameraPlace {
  std::optional<double> azimuth_degrees, elevation_degrees, field_of_view_degrees, distance, zoom;
  std::optional<Eigen::Vector3d> target;
};

/// Moment of a camera.
struct CameraKeyframe {
  double time = 0;  ///< seconds
  CameraPlace place;
};

/// Moments of a camera, in the order of time, interpolated linearly.
struct CameraKeyframes {
  std::vector<CameraKeyframe> frames;
  MotionEnds ends = MotionEnds::hold;
};

/// A way around the camera's target about +Y, at an even speed.
struct CameraOrbit {
  double period = 1;         ///< seconds, not 0; below 0: the other way
  double phase_degrees = 0;  ///< at time 0, added to the azimuth
};

/// A camera as a scene states it, which may move.
struct SceneCamera : CameraPlace {
  std::string name = {};  ///< empty: the scene's only one
  std::variant<std::monostate, CameraKeyframes, CameraOrbit> motion = {};
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
  std::vector<std::filesystem::path> meshes;  ///< files with uvs, without transfer
  std::filesystem::path shaders;              ///< folder of shaders of one's own; empty: none
  std::vector<SceneLight> lights;             ///< all with a lamp, or none
  std::filesystem::path environment;          ///< empty: none
  double environment_rotation_degrees = 0;
  LightWindow window = LightWindow::hann;
  std::vector<SceneCamera> cameras = {{}};         ///< at least one; the first is the one to begin with
  std::optional<std::array<float, 3>> background;  ///< linear, behind the scene and in its mirror; nothing: none
  TreeChoice tree = TreeChoice::given;
  std::optional<double> duration;  ///< seconds; nothing: that of the longest motion
};

/// Returns the seconds that the scene's film takes; 0 where nothing moves.
double duration_of(const SceneDescription& scene);

/// Returns a camera at a time.
CameraPlace camera_at(const SceneCamera& camera, double time);

/// Returns the index of the camera of that name; of the first for an empty one, of none -1.
int find_camera(const SceneDescription& scene, const std::string& name);

/// Returns a light at a time.
LightSpec light_at(const SceneLight& light, double time);

}  // namespace kiln
