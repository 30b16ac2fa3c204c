// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>

#include "bake/bake_settings.h"
#include "bake/scene/occluders.h"
#include "bake/scene/receiver_set.h"
#include "base/progress.h"

namespace kiln {

/// Part of a bake that several machines share: every `count`-th block of directions, from the `index`-th on (from 1).
struct Shard {
  int index = 1;
  int count = 1;
};

/// Parses "k/n". Throws WrongUsage.
Shard parse_shard(const std::string& text);

/// Files of sums from which an interrupted bake goes on.
struct Checkpoints {
  std::filesystem::path folder;  ///< empty: no checkpoints
  double seconds = 60;           ///< between two checkpoints; 0: after every step
  bool resume = false;           ///< go on from the checkpoints in the folder, if there are any
};

/// A bake: what receives light, what shadows it, and how. The receivers and occluders outlive the job.
struct BakeJob {
  const ReceiverSet& receivers;
  const Occluders& occluders;
  BakeSettings settings = {};
  int seed = 0;
  int threads = 0;  ///< threads of a software GL renderer; 0: all
  Checkpoints checkpoints = {};
  ProgressFunction progress = no_progress;
};

}  // namespace kiln
