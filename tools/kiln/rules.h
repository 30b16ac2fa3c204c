// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/makefile.h"
#include "kiln/pipeline.h"
#include "kiln/stage_state.h"

namespace kiln {

/// Makes the rules of every asset of the pipeline; those of one asset are adjacent, and in order.
std::vector<MakeRule> make_rules(const Pipeline& pipeline);

/// Collects everything that changes the result of a run's command: its words, the version, and the programs by content,
/// so that a moved build does not make everything anew and a changed one does. `programs` are the hashes of the folder
/// of the stages' executables. Throws MachineLacks if one is missing.
std::string stamp_text(const StageRun& run, FileHashes& programs);

}  // namespace kiln
