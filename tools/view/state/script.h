// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "view/state/view_state.h"

namespace kiln {

/// One line of a script: what a person at the window would do, or look at.
struct ScriptStep {
  enum class Kind {
    key,         ///< press `key`
    drag,        ///< `what` by `x` pixels to the right and `y` downwards
    wheel,       ///< `x` steps forwards
    resize,      ///< the window to `x` x `y` pixels
    frames,      ///< draw `x` of them
    screenshot,  ///< write the picture to `file`
    window,      ///< the same with the panels, as the window is
    reload,      ///< wait until the files have changed and were read again
  };
  Kind kind = Kind::frames;
  char key = 0;
  Drag what = Drag::orbit;
  double x = 0, y = 0;
  std::filesystem::path file;
};

/// What scripts are made of, for --help and messages.
extern const char* const script_grammar;

/// Reads a script, one step a line; several keys to a line are several steps, # begins a comment. Throws BadInput that
/// names the line.
std::vector<ScriptStep> read_script(const std::filesystem::path& file);

}  // namespace kiln
