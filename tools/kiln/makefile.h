#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// A run and the file that changes when its command does.
struct MakeRule {
  std::string asset;
  StageRun run;
  std::filesystem::path stamp;
};

/// The Makefile that runs `rules`: one rule per stage of an asset, that makes the stage's record (and with it all its
/// outputs) where the files it reads or its stamp are newer or an output is missing; `make ASSET` makes all of one
/// asset. It is run from the folder that relative paths start from. `THREADS` (of each stage, 0 for all cores), `STEP`
/// (what runs a stage) and `PROGRAMS` can be set from outside.
std::string makefile_text(const std::vector<MakeRule>& rules, const std::filesystem::path& programs);

/// A word as a POSIX shell reads it back.
std::string shell_quoted(const std::string& word);

/// A path as make reads it back in targets and prerequisites.
std::string make_quoted(const std::filesystem::path& path);

}  // namespace kiln
