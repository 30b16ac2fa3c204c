// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// A run, and the files in the output folder's .kiln/ that go with it.
struct MakeRule {
  std::string asset;
  StageRun run;
  std::filesystem::path plan;   ///< what is run, for the step that runs it (StagePlan)
  std::filesystem::path state;  ///< what the last run read and made
};

/// The rules that make what each rule reads: indices, in the order of the rules.
std::vector<std::vector<std::size_t>> needs_of(const std::vector<MakeRule>& rules);

/// What make calls each rule: "3.bake" for the third asset's. File names stand in no rule, for make cannot hold them
/// all.
std::vector<std::string> targets_of(const std::vector<MakeRule>& rules);

/// The Makefile that runs `rules`: a phony target for each, which waits for those it needs and then has `kiln step` see
/// by content whether the stage must run; `make NAME` makes an asset whose name is a plain word. It is run from the
/// folder that relative paths start from. `THREADS` (of each stage, 0 for all cores) and `PROGRAMS` can be set from
/// outside.
std::string makefile_text(const std::vector<MakeRule>& rules, const std::filesystem::path& programs);

/// A word as a POSIX shell reads it back.
std::string shell_quoted(const std::string& word);

/// A command line on one line, for people: control characters as \NNN.
std::string shown_command(const std::vector<std::string>& words);

}  // namespace kiln
