// SPDX-License-Identifier: GPL-3.0-or-later
#include "view/state/scene_state.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace kiln {

namespace {

struct NamedKey {
  std::string_view name;
  char key;
};
constexpr std::array named_keys = {NamedKey{"escape", escape_key}, NamedKey{"space", ' '}, NamedKey{"left", left_key},
                                   NamedKey{"right", right_key},   NamedKey{"up", up_key}, NamedKey{"down", down_key}};
constexpr std::string_view character_keys = " +=-ihsrq";

/// Returns the distance along a ray to a triangle, both sides, or infinity [Moller 1997].
double distance_to(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                   const std::array<Eigen::Vector3d, 3>& corners) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::Vector3d first = corners[1] - corners[0], second = corners[2] - corners[0], p = along.cross(second);
  const double determinant = first.dot(p);
  if (determinant == 0) return none;
  const Eigen::Vector3d t = from - corners[0], q = t.cross(first);
  const double u = t.dot(p) / determinant, v = along.dot(q) / determinant, distance = second.dot(q) / determinant;
  return u >= 0 && v >= 0 && u + v <= 1 && distance > 0 ? distance : none;
}

std::string help_text(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string text;
  for (const auto& [keys, does] : rows) text += fmt::format("  {:<14}{}\n", keys, does);
  return text;
}

}  // namespace

double looped(double time, double duration) {
  return duration > 0 && time > duration ? std::fmod(time, duration) : time;
}

Wish press_scene_key(SceneState& state, const SceneState& home, double duration, char key) {
  const auto step = [&](double seconds) {
    state.plays = false;
    const double end = duration > 0 ? duration : std::numeric_limits<double>::infinity();
    state.time = std::clamp(state.time + seconds, 0.0, std::max(end, state.time));
  };
  switch (key) {
    case ' ':
      state.plays = !state.plays;
      break;
    case left_key:
      step(-scene_frame_seconds);
      break;
    case right_key:
      step(scene_frame_seconds);
      break;
    case up_key:
      step(0.5);
      break;
    case down_key:
      step(-0.5);
      break;
    case '+':
    case '=':
      state.exposure_stops = std::min(20.0, state.exposure_stops + 0.5);
      break;
    case '-':
      state.exposure_stops = std::max(-20.0, state.exposure_stops - 0.5);
      break;
    case 'i':
      state.readout = !state.readout;
      break;
    case 'h':
      state.help = !state.help;
      break;
    case 'r':
      state = home;
      break;
    case 's':
      return Wish::screenshot;
    case 'q':
    case escape_key:
      return Wish::close;
    default:
      break;
  }
  return Wish::none;
}

std::vector<std::pair<std::string, std::string>> scene_key_help() {
  return {{"space", "play, pause"},
          {"left  right", "a thirtieth of a second back, forward"},
          {"down  up", "half a second back, forward"},
          {"+  -", "exposure"},
          {"i", "the panel of what is shown"},
          {"h", "keys"},
          {"s", "screenshot, without the panels"},
          {"r", "reset all"},
          {"q  Esc", "close"},
          {"left drag", "of a node: moves it across the view; elsewhere: orbit"},
          {"middle drag", "pan; also shift and left drag"},
          {"wheel", "zoom"}};
}

std::string scene_key_help_text() { return help_text(scene_key_help()); }

char scene_key_named(std::string_view name) {
  for (const NamedKey& named : named_keys)
    if (named.name == name) return named.key;
  return name.size() == 1 && character_keys.find(name) != std::string_view::npos ? name.front() : '\0';
}

ScriptWords scene_script_words(bool can_reload) {
  return {scene_key_named, true, can_reload,
          "key KEY... (also space, left, right, up, down), drag left|middle RIGHT DOWN (pixels), move X Y RIGHT DOWN "
          "(from a pixel, counted from the upper left), wheel STEPS, resize WIDTH HEIGHT, frames COUNT, screenshot "
          "FILE.png, window FILE.png (panels included)" +
              std::string(can_reload ? ", reload (waits for it)" : "")};
}

int item_at(MovingScene& scene, const Camera& camera, double right, double down, int width, int height) {
  const double across = 2 * right / width - 1, up = 1 - 2 * down / height;
  const Eigen::Vector3d along = camera.forward.cast<double>() +
                                across * camera.half_width * camera.right.cast<double>() +
                                up * camera.half_height * camera.up.cast<double>();
  double nearest = std::numeric_limits<double>::infinity();
  int found = -1;
  for (int item = 0; item < scene.item_count(); ++item) {
    if (scene.mesh_of(item) == nullptr) continue;
    const Placement& pose = scene.pose(item);
    const Eigen::Vector3d from = pose.to_object(camera.position.cast<double>()),
                          direction = pose.rotation.transpose() * along / pose.scale;  // distances stay the scene's
    const TriangleMesh& mesh = *scene.mesh_of(item);
    for (const Triangle& triangle : mesh.triangles) {
      const auto corner = [&](std::size_t k) { return mesh.positions[triangle[k]].cast<double>().eval(); };
      const double distance = distance_to(from, direction, {corner(0), corner(1), corner(2)});
      if (distance < nearest) {
        nearest = distance;
        found = item;
      }
    }
  }
  return found;
}

void drag_item(MovingScene& scene, int item, const Camera& camera, double right_pixels, double down_pixels,
               int height) {
  const Eigen::Vector3d middle = scene.pose(item).to_scene(bounding_box(*scene.mesh_of(item)).centre().cast<double>());
  const double depth = (middle - camera.position.cast<double>()).dot(camera.forward.cast<double>());
  const double units_per_pixel = 2.0 * camera.half_height * depth / height;
  scene.move(item,
             units_per_pixel * (right_pixels * camera.right.cast<double>() - down_pixels * camera.up.cast<double>()));
}

bool can_be_dragged(const MovingScene& scene, int item) { return item >= 0 && !scene.item(item).is_static; }

Panel scene_readout(const SceneState& state, const SceneFacts& facts) {
  Panel panel{facts.name, {}};
  const auto row = [&](const char* label, std::string value) { panel.rows.push_back({label, std::move(value)}); };
  row("Time", facts.duration > 0
                  ? fmt::format("{:.2f} of {:.2f} s{}", state.time, facts.duration, state.plays ? ", playing" : "")
                  : "nothing moves");
  row("Nodes", fmt::format("{}", facts.assets));
  row("Shadows", facts.shadows);
  row("Light at", facts.samples);
  if (state.exposure_stops != 0) row("Exposure", fmt::format("{:+.1f} stops", state.exposure_stops));
  row("Light", facts.lights_milliseconds > 0 ? fmt::format("{:.1f} ms", facts.lights_milliseconds) : "...");
  row("Frame", facts.frame_milliseconds > 0 ? fmt::format("{:.1f} ms", facts.frame_milliseconds) : "...");
  return panel;
}

Panel scene_help_panel() {
  Panel panel{"Keys", {}};
  for (const auto& [keys, does] : scene_key_help()) panel.rows.push_back({keys, does});
  return panel;
}

}  // namespace kiln
