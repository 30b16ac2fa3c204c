// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/process.h"
#include "kiln/step.h"

namespace kiln {

struct MakeSettings {
  std::filesystem::path folder;    ///< working folder
  std::filesystem::path makefile;  ///< relative to that folder
  std::vector<std::string> targets;
  int jobs = 1;
  int threads = 1;  ///< threads of each stage
  bool keep_going = false;
  bool alone = true;  ///< whether no two stages run at a time
};

struct MakeEnd {
  ProcessEnd end;
  std::vector<std::string> errors;  ///< make's own lines
  std::vector<StepEvent> events;    ///< one for each stage that ran
};

/// Runs make, and passes the stages' messages on to stderr.
MakeEnd run_make(const MakeSettings& settings);

/// Throws make's own message, for a failure without a failed stage.
[[noreturn]] void fail_as_make(const MakeEnd& make);

}  // namespace kiln
