// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// A stage's run, and its files in the output folder's .kiln/.
struct MakeRule {
  std::string asset;
  StageRun run;
  std::filesystem::path plan;   ///< the run, written down for the step that carries it out (StagePlan)
  std::filesystem::path state;  ///< what the last run read and made
};

/// Finds, for each rule, the rules that make what it reads: indices, in the order of the rules.
std::vector<std::vector<std::size_t>> needs_of(const std::vector<MakeRule>& rules);

/// Names each rule's target for make: "3.bake" is the bake of the third asset. Rules contain no file names, since make
/// cannot represent all of them.
std::vector<std::string> targets_of(const std::vector<MakeRule>& rules);

/// Makes the text of the Makefile that runs `rules`: a phony target for each, which waits for those that it needs and
/// then has `kiln step` decide by content whether the stage must run. `make NAME` makes an asset whose name is a plain
/// word. The Makefile runs in the folder that relative paths start from. `THREADS` (of each stage, 0 for all cores) and
/// `PROGRAMS` can be set from outside.
std::string makefile_text(const std::vector<MakeRule>& rules, const std::filesystem::path& programs);

/// Quotes a word for a POSIX shell.
std::string shell_quoted(const std::string& word);

/// Formats a command line as one line for people: control characters become \NNN.
std::string shown_command(const std::vector<std::string>& words);

}  // namespace kiln
