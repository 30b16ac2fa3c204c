// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "view/state/view_state.h"

namespace kiln {

/// One line of a script: an action of a person at the window, or something to look at.
struct ScriptStep {
  enum class Kind {
    key,         ///< press `key`
    drag,        ///< drag `what` by `x` pixels to the right and `y` downwards
    wheel,       ///< turn the wheel `x` steps forwards
    resize,      ///< resize the window to `x` x `y` pixels
    frames,      ///< draw `x` frames
    screenshot,  ///< write the picture to `file`
    window,      ///< write the window with its panels to `file`
    reload,      ///< wait until the files have changed and been read again
    move,        ///< drag what is at pixel (`from_x`, `from_y`) from the upper left, as `drag` does; of scenes alone
  };
  Kind kind = Kind::frames;
  char key = 0;
  Drag what = Drag::orbit;
  double x = 0, y = 0;
  double from_x = 0, from_y = 0;
  std::filesystem::path file;
};

/// Grammar of scripts, for --help and messages.
extern const char* const script_grammar;

/// What scripts for one kind of window may say.
struct ScriptWords {
  std::function<char(std::string_view)> key_named;
  bool moves = false;    ///< has `move`
  bool reloads = false;  ///< has `reload`
  std::string grammar;
};

/// Words of scripts for an asset.
ScriptWords asset_script_words();

/// Reads a script, one step per line; several keys on a line are several steps, # begins a comment. Throws BadInput
/// that names the line.
std::vector<ScriptStep> read_script(const std::filesystem::path& file, const ScriptWords& words = asset_script_words());

}  // namespace kiln
