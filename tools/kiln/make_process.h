// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/process.h"
#include "kiln/step.h"

namespace kiln {

struct MakeSettings {
  std::filesystem::path folder;    ///< to run in
  std::filesystem::path makefile;  ///< seen from there
  std::vector<std::string> targets;
  int jobs = 1;
  int threads = 1;  ///< of each stage
  bool keep_going = false;
  bool alone = true;  ///< no two stages run at a time
};

struct MakeEnd {
  ProcessEnd end;
  std::vector<std::string> errors;  ///< make's own lines
  std::vector<StepEvent> events;    ///< the stages that ran
};

/// Runs make, and lets the stages' messages through to stderr.
MakeEnd run_make(const MakeSettings& settings);

/// Throws what make said when it failed and no stage did.
[[noreturn]] void fail_as_make(const MakeEnd& make);

}  // namespace kiln
