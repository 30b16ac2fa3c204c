// SPDX-License-Identifier: MIT
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>
#include <vector>

#include "runtime/scene/scene_description.h"
#include "yaml/yaml_file.h"

namespace kiln {

/// Largest number that a scene may have.
inline constexpr double most_scene_number = 1e6;

/// Reads values of scene.yaml; every function throws BadInput at the value's line.
class SceneValues {
 public:
  explicit SceneValues(const YamlFile& file) : file_(file) {}

  double number(const YAML::Node& node, double lowest, double highest) const;
  double above_zero(const YAML::Node& node) const;
  bool yes_or_no(const YAML::Node& node) const;
  /// Reads a list of so many numbers.
  std::vector<double> numbers(const YAML::Node& node, std::size_t count, double lowest, double highest,
                              const std::string& expected) const;
  /// Reads one number, or a list of one to four.
  std::vector<double> components(const YAML::Node& node) const;
  Eigen::Vector3d place(const YAML::Node& node) const;
  /// Reads a direction of any length but 0, and normalises it.
  Eigen::Vector3d axis(const YAML::Node& node) const;
  /// Reads azimuth and elevation, degrees.
  std::array<double, 2> angles(const YAML::Node& node) const;
  /// Reads a radiance: one number, or red, green and blue.
  std::array<float, 3> color(const YAML::Node& node) const;
  /// Reads {axis, degrees}.
  Eigen::Quaterniond rotation(const YAML::Node& node) const;
  /// Reads a uniform scale.
  double scale(const YAML::Node& node) const;

  /// Reads `animate` of a node.
  Motion motion(const YAML::Node& animate) const;
  /// Reads one of `lights` that is no environment.
  SceneLight light(const YAML::Node& node) const;
  /// Reads `camera`, or one of `cameras`, which have names.
  SceneCamera camera(const YAML::Node& node, bool has_name) const;

 private:
  /// Requires one of `choices` among the keys of a map, and returns it.
  std::string only_key(const YAML::Node& map, const std::vector<std::string>& choices) const;
  CircularOrbit circle(const YAML::Node& node, bool has_radius) const;
  MotionEnds ends(const YAML::Node& animate) const;
  /// Reads the time of a keyframe, which is later than `before`.
  double frame_time(const YAML::Node& frame, double before) const;
  /// Returns the list of keyframes.
  YAML::Node frames(const YAML::Node& animate) const;
  /// Reads what a keyframe or the camera itself says.
  CameraPlace camera_place(const YAML::Node& node) const;
  void camera_motion(const YAML::Node& animate, SceneCamera& camera) const;
  void light_motion(const YAML::Node& animate, SceneLight& light) const;

  const YamlFile& file_;
};

}  // namespace kiln
