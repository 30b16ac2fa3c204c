// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "mesh/camera.h"
#include "runtime/play/moving_scene.h"
#include "view/state/keys.h"
#include "view/state/orbit.h"
#include "view/state/panel_text.h"
#include "view/state/script.h"

namespace kiln {

/// Everything that the person at the window chose about a scene.
struct SceneState {
  Orbit orbit;
  double time = 0;  ///< seconds
  bool plays = false;
  int held = -1;  ///< item that the pointer holds; -1: none, so that drags turn the camera
  double exposure_stops = 0;
  bool readout = true;
  bool help = false;
};

/// Time between the frames of a script that plays, and a step of the arrows, seconds.
inline constexpr double scene_frame_seconds = 1.0 / 30;

/// Carries out a key's action on a scene of so many seconds. `home` is the state that `r` returns to.
Wish press_scene_key(SceneState& state, const SceneState& home, double duration, char key);

/// Lists the keys and what they do, in the order of the help; then what the pointer does.
std::vector<std::pair<std::string, std::string>> scene_key_help();
std::string scene_key_help_text();

/// Finds a key of a scene by its name in scripts: one character, escape, space, left, right, up or down. 0 if there is
/// none of that name.
char scene_key_named(std::string_view name);

/// Words of scripts for a scene; `can_reload`: one whose files are read again when they change.
ScriptWords scene_script_words(bool can_reload = false);

/// Brings a time that plays on past the end back to the beginning.
double looped(double time, double duration);

/// Finds the item whose surface is nearest behind a pixel, rows from the top; -1 if there is none.
int item_at(MovingScene& scene, const Camera& camera, double right, double down, int width, int height);

/// Moves an item in the plane through its middle that faces the camera, so that it follows the pointer.
void drag_item(MovingScene& scene, int item, const Camera& camera, double right_pixels, double down_pixels, int height);

/// Tests whether an item may be moved by hand.
bool can_be_dragged(const MovingScene& scene, int item);

/// Measurements of the window for its panel.
struct SceneFacts {
  std::string name;                ///< of the scene's file
  double duration = 0;             ///< seconds
  int assets = 0;                  ///< nodes with an asset
  std::string shadows;             ///< method
  std::string samples;             ///< points at which light is computed
  double frame_milliseconds = 0;   ///< 0: not yet known
  double lights_milliseconds = 0;  ///< part of it that is the light of all nodes
};

Panel scene_readout(const SceneState& state, const SceneFacts& facts);
Panel scene_help_panel();

}  // namespace kiln
