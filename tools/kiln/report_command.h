// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <vector>

#include "kiln/pipeline.h"
#include "kiln/summary.h"

namespace kiln {

struct ReportCommand {
  std::filesystem::path baseline;  ///< a metrics.json, the folder of one, or a folder of such; empty: none
  bool same_run = false;           ///< whether the baseline was built on this machine in the same run
  bool always = false;             ///< whether summary.md is written where all is well
  bool json = false;
  bool quiet = false;
};

/// Writes junit.xml and summary.md of what is built of the assets into the output folder, and with a baseline
/// comparison.html, comparison.json and their pictures. Builds nothing. Returns the exit status: 4 where something
/// fails: a missed budget, an asset without a report or a picture, a baseline that shares no asset. Throws BadInput
/// where the baseline does not exist or is no metrics.
int report_on(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const ReportCommand& settings);

/// Writes junit.xml and summary.md after a build of these assets. One that failed, or was not reached, fails there too,
/// whatever an earlier build has left.
void write_gate_files(const Pipeline& pipeline, const std::vector<AssetOutcome>& outcomes);

/// Removes both.
void remove_gate_files(const Pipeline& pipeline);

}  // namespace kiln
