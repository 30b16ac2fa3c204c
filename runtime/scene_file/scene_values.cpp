// SPDX-License-Identifier: MIT
#include "runtime/scene_file/scene_values.h"

#include <cmath>
#include <numbers>
#include <sstream>

#include "base/errors.h"

namespace kiln {

namespace {

using Kind = LightSpec::Kind;

std::string range_text(double lowest, double highest) {
  std::ostringstream text;
  text << "a number of " << lowest << " to " << highest;
  return text.str();
}

}  // namespace

double SceneValues::number(const YAML::Node& node, double lowest, double highest) const {
  file_.scalar(node, range_text(lowest, highest));
  const std::string text = file_.number(node);
  const double value = std::stod(text);
  file_.require(value >= lowest && value <= highest, node, "'" + text + "'", range_text(lowest, highest));
  return value;
}

double SceneValues::above_zero(const YAML::Node& node) const {
  const double value = number(node, 0, most_scene_number);
  file_.require(value > 0, node, "0", "a number above 0");
  return value;
}

bool SceneValues::yes_or_no(const YAML::Node& node) const {
  const std::string word = file_.scalar(node, "true or false");
  file_.require(word == "true" || word == "false", node, "'" + word + "'", "true or false");
  return word == "true";
}

std::vector<double> SceneValues::numbers(const YAML::Node& node, std::size_t count, double lowest, double highest,
                                         const std::string& expected) const {
  file_.require(node.IsSequence(), node, node.IsScalar() ? "'" + node.Scalar() + "'" : "no list", expected);
  file_.require(node.size() == count, node, std::to_string(node.size()) + " numbers", expected);
  std::vector<double> values;
  for (const YAML::Node& part : node) values.push_back(number(part, lowest, highest));
  return values;
}

std::vector<double> SceneValues::components(const YAML::Node& node) const {
  if (!node.IsSequence()) return {number(node, -most_scene_number, most_scene_number)};
  const std::string expected = "a number, or a list of up to four";
  file_.require(node.size() >= 1 && node.size() <= 4, node, std::to_string(node.size()) + " numbers", expected);
  return numbers(node, node.size(), -most_scene_number, most_scene_number, expected);
}

Eigen::Vector3d SceneValues::place(const YAML::Node& node) const {
  return Eigen::Vector3d(numbers(node, 3, -most_scene_number, most_scene_number, "three numbers, [X, Y, Z]").data());
}

Eigen::Vector3d SceneValues::axis(const YAML::Node& node) const {
  const Eigen::Vector3d along = place(node);
  file_.require(along.norm() > 1e-9, node, "an axis of length 0", "a direction, as [0, 1, 0]");
  return along.normalized();
}

std::array<double, 2> SceneValues::angles(const YAML::Node& node) const {
  const std::string expected = "two numbers, [AZIMUTH, ELEVATION] in degrees";
  const std::vector<double> values = numbers(node, 2, -36000, 36000, expected);
  file_.require(std::abs(values[1]) <= 90, node, "an elevation of '" + node[1].Scalar() + "'",
                expected + ", an elevation of -90 to 90");
  return {values[0], values[1]};
}

std::array<float, 3> SceneValues::color(const YAML::Node& node) const {
  if (node.IsScalar()) {
    const auto grey = static_cast<float>(number(node, 0, most_scene_number));
    return {grey, grey, grey};
  }
  const std::vector<double> values =
      numbers(node, 3, 0, most_scene_number, "a radiance: one number, or three, [RED, GREEN, BLUE]");
  return {static_cast<float>(values[0]), static_cast<float>(values[1]), static_cast<float>(values[2])};
}

Eigen::Quaterniond SceneValues::rotation(const YAML::Node& node) const {
  file_.check_keys(node, {"axis", "degrees"});
  file_.require(node["axis"].IsDefined() && node["degrees"].IsDefined(), node, "half a rotation",
                "both axis and degrees");
  const double degrees = number(node["degrees"], -36000, 36000);
  return Eigen::Quaterniond(Eigen::AngleAxisd(degrees * std::numbers::pi / 180, axis(node["axis"])));
}

double SceneValues::scale(const YAML::Node& node) const {
  file_.require(node.IsScalar() || node.IsNull(), node, "a scale of several numbers",
                "one number above 0: scales are uniform, since light turns and does not shear");
  return above_zero(node);
}

std::string SceneValues::only_key(const YAML::Node& map, const std::vector<std::string>& choices) const {
  std::string found, list;
  for (const std::string& choice : choices) {
    list += (list.empty() ? "" : ", ") + choice;
    if (!map.IsMap() || !map[choice].IsDefined()) continue;
    file_.require(found.empty(), map[choice], "both " + found + " and " + choice, "one of them");
    found = choice;
  }
  file_.require(!found.empty(), map, map.IsScalar() ? "'" + map.Scalar() + "'" : "none of these", "one of " + list);
  return found;
}

CircularOrbit SceneValues::circle(const YAML::Node& node, bool has_radius) const {
  std::vector<std::string> keys = {"axis", "period", "phase"};
  if (has_radius) keys.insert(keys.end(), {"radius", "turns"});
  file_.check_keys(node, keys);
  CircularOrbit orbit;
  if (node["axis"]) orbit.axis = axis(node["axis"]);
  file_.require(node["period"].IsDefined(), node, "an orbit without a period", "period, in seconds");
  orbit.period = number(node["period"], -most_scene_number, most_scene_number);
  file_.require(orbit.period != 0, node["period"], "a period of 0", "seconds, above 0 or, for the other way, below");
  if (node["phase"]) orbit.phase_degrees = number(node["phase"], -36000, 36000);
  if (!has_radius) return orbit;
  file_.require(node["radius"].IsDefined(), node, "an orbit without a radius", "radius, 0 or more");
  orbit.radius = number(node["radius"], 0, most_scene_number);
  if (node["turns"]) orbit.turns = yes_or_no(node["turns"]);
  file_.require(orbit.radius > 0 || orbit.turns, node["radius"], "a radius of 0, by which nothing moves",
                "a radius above 0, or 'turns: true'");
  return orbit;
}

MotionEnds SceneValues::ends(const YAML::Node& animate) const {
  const YAML::Node node = animate["ends"];
  if (!node.IsDefined()) return MotionEnds::hold;
  const std::string word = file_.scalar(node, "hold, repeat or mirror");
  file_.require(word == "hold" || word == "repeat" || word == "mirror", node, "'" + word + "'",
                "hold, repeat or mirror");
  return word == "hold" ? MotionEnds::hold : word == "repeat" ? MotionEnds::repeat : MotionEnds::mirror;
}

double SceneValues::frame_time(const YAML::Node& frame, double before) const {
  file_.require(frame["time"].IsDefined(), frame, "a keyframe without a time", "time, in seconds");
  file_.require(frame.size() > 1, frame, "a keyframe with a time alone", "something that it says of that time");
  const double time = number(frame["time"], 0, most_scene_number);
  file_.require(time > before, frame["time"], "the time '" + frame["time"].Scalar() + "' after a later one, or again",
                "keyframes in the order of time, each time once");
  return time;
}

YAML::Node SceneValues::frames(const YAML::Node& animate) const {
  const YAML::Node list = animate["keyframes"];
  file_.require(list.IsSequence() && list.size() > 0, list, "no keyframes", "a list of keyframes, each with a time");
  return list;
}

Motion SceneValues::motion(const YAML::Node& animate) const {
  if (only_key(animate, {"keyframes", "orbit"}) == "orbit") {
    file_.check_keys(animate, {"orbit"});
    return circle(animate["orbit"], true);
  }
  file_.check_keys(animate, {"keyframes", "ends"});
  Keyframes keyframes{{}, ends(animate)};
  double before = -1;
  for (const YAML::Node& node : frames(animate)) {
    file_.check_keys(node, {"time", "translate", "rotate", "scale"});
    Keyframe& frame = keyframes.frames.emplace_back();
    before = frame.time = frame_time(node, before);
    if (node["translate"]) frame.translation = place(node["translate"]);
    if (node["rotate"]) frame.rotation = rotation(node["rotate"]);
    if (node["scale"]) frame.scale = scale(node["scale"]);
  }
  return keyframes;
}

void SceneValues::light_motion(const YAML::Node& animate, SceneLight& light) const {
  const bool is_ball = light.spec.kind == Kind::sphere;
  if (only_key(animate, {"keyframes", "orbit"}) == "orbit") {
    file_.check_keys(animate, {"orbit"});
    light.motion = circle(animate["orbit"], is_ball);
    return;
  }
  file_.check_keys(animate, {"keyframes", "ends"});
  LightKeyframes keyframes{{}, ends(animate)};
  const std::string key = is_ball ? "sphere" : light.spec.kind == Kind::hemisphere ? "hemisphere" : "directional";
  double before = -1;
  for (const YAML::Node& node : frames(animate)) {
    file_.check_keys(node, {"time", key, "radiance"});
    LightKeyframe& frame = keyframes.frames.emplace_back();
    before = frame.time = frame_time(node, before);
    if (const YAML::Node at = node[key]) {
      if (is_ball) {
        frame.place = place(at);
      } else {
        const std::array<double, 2> towards = angles(at);
        frame.place = Eigen::Vector3d(towards[0], towards[1], 0);
      }
    }
    if (node["radiance"]) frame.radiance = color(node["radiance"]);
  }
  light.motion = keyframes;
}

SceneLight SceneValues::light(const YAML::Node& node) const {
  SceneLight light;
  LightSpec& spec = light.spec;
  const std::string kind = only_key(node, {"directional", "sphere", "hemisphere", "ambient", "environment"});
  const YAML::Node main = node[kind];
  std::vector<std::string> keys = {kind};
  if (kind != "environment") keys.emplace_back("lamp");
  if (kind != "ambient") keys.insert(keys.end(), {"radiance", "animate"});
  if (kind == "directional" || kind == "sphere") keys.emplace_back("radius");
  if (kind == "hemisphere") keys.emplace_back("ground");
  file_.check_keys(node, keys);
  light.where = file_.where(node);
  if (node["lamp"]) light.lamp = file_.scalar(node["lamp"], "a lamp, such as D65 or F11, or a file of a spectrum");
  if (kind == "ambient") {
    spec.kind = Kind::ambient;
    spec.color = color(main);
    return light;
  }
  if (kind == "sphere") {
    spec.kind = Kind::sphere;
    const Eigen::Vector3d at = place(main);
    spec.position = {at.x(), at.y(), at.z()};
    file_.require(node["radius"].IsDefined(), node, "a ball of light without a radius", "radius, above 0");
    spec.radius = above_zero(node["radius"]);
  } else {
    const std::array<double, 2> towards = angles(main);
    spec.azimuth_degrees = towards[0];
    spec.elevation_degrees = towards[1];
    if (kind == "hemisphere") spec.kind = Kind::hemisphere;
    if (kind == "directional" && node["radius"]) {
      const double half_angle = number(node["radius"], 0, 180);
      if (half_angle > 0) spec.kind = Kind::cone, spec.half_angle_degrees = half_angle;
    }
  }
  if (node["radiance"]) spec.color = color(node["radiance"]);
  if (node["ground"]) spec.ground = color(node["ground"]);
  if (node["animate"]) light_motion(node["animate"], light);
  return light;
}

CameraPlace SceneValues::camera_place(const YAML::Node& node) const {
  CameraPlace place;
  if (node["azimuth"]) place.azimuth_degrees = number(node["azimuth"], -36000, 36000);
  if (node["elevation"]) place.elevation_degrees = number(node["elevation"], -90, 90);
  if (node["field-of-view"]) place.field_of_view_degrees = number(node["field-of-view"], 1, 120);
  if (node["target"]) place.target = this->place(node["target"]);
  if (node["distance"]) place.distance = above_zero(node["distance"]);
  if (node["zoom"]) place.zoom = above_zero(node["zoom"]);
  return place;
}

void SceneValues::camera_motion(const YAML::Node& animate, SceneCamera& camera) const {
  if (only_key(animate, {"keyframes", "orbit"}) == "orbit") {
    file_.check_keys(animate, {"orbit"});
    const YAML::Node node = animate["orbit"];
    file_.check_keys(node, {"period", "phase"});
    file_.require(node["period"].IsDefined(), node, "an orbit without a period", "'period', seconds");
    CameraOrbit orbit;
    orbit.period = number(node["period"], -most_scene_number, most_scene_number);
    file_.require(orbit.period != 0, node["period"], "a period of 0", "seconds, below 0 for the other way");
    if (node["phase"]) orbit.phase_degrees = number(node["phase"], -36000, 36000);
    camera.motion = orbit;
    return;
  }
  file_.check_keys(animate, {"keyframes", "ends"});
  CameraKeyframes keyframes{{}, ends(animate)};
  double before = -1;
  for (const YAML::Node& node : frames(animate)) {
    file_.check_keys(node, {"time", "azimuth", "elevation", "field-of-view", "target", "distance", "zoom"});
    before = frame_time(node, before);
    keyframes.frames.push_back({before, camera_place(node)});
  }
  camera.motion = keyframes;
}

SceneCamera SceneValues::camera(const YAML::Node& node, bool has_name) const {
  std::vector<std::string> keys = {"azimuth", "elevation", "field-of-view", "target", "distance", "zoom", "animate"};
  if (has_name) keys.emplace_back("name");
  file_.check_keys(node, keys);
  SceneCamera camera;
  static_cast<CameraPlace&>(camera) = camera_place(node);
  file_.require(!has_name || node["name"].IsDefined(), node, "a camera without a name",
                "'name', which no other camera has");
  if (has_name) camera.name = file_.scalar(node["name"], "a name");
  if (node["animate"]) camera_motion(node["animate"], camera);
  return camera;
}

}  // namespace kiln
