// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bake/bake_files.h"
#include "base/outputs.h"

namespace kiln {

/// How a bake is carried out, as opposed to what it computes.
struct BakeRun {
  std::string shard;                          ///< "k/n"; empty: all of it
  std::vector<std::filesystem::path> shards;  ///< folders to merge
  bool resume = false;
  double checkpoint_seconds = 60;

  bool is_shard() const { return !shard.empty(); }
};

/// Adds the options of a run, under a heading of their own. They are not part of the settings on record.
void add_run_options(CommandLine& command, BakeRun& run);

/// Integrates, integrates one shard into `outputs`, or merges shards, as `run` says; then scatters beneath the surface,
/// if settings ask for it. Throws WrongUsage for options that do not go together, and what bake(), bake_shard() and
/// merge_shards() throw.
BakeResult run_bake(OutputSet& outputs, const BakePaths& paths, const BakeScene& scene, const BakeSettings& settings,
                    const BakeRun& run, const CommandLine& command);

/// Removes the checkpoints of an interrupted bake of this output, `<output>.checkpoint/` beside it.
void remove_checkpoints(const BakePaths& paths);

}  // namespace kiln
