// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/pipeline.h"
#include "kiln/rules.h"

namespace kiln {

struct BuildSettings {
  int jobs = 0;             ///< stages at a time; 0: as many as there are cores
  bool keep_going = false;  ///< build the other assets where one fails
  bool dry_run = false;     ///< say what would run, run and write nothing
  bool force = false;       ///< run all stages of the assets, also those that are up to date
  std::string until;        ///< the last stage to run; empty: all do
  bool quiet = false;
  bool json = false;  ///< the outcome as one JSON object on stdout
};

/// Brings the assets up to date through make. Returns the exit status: that of the failed stage, the gravest
/// where several failed (see gravest_status), 4 where all is built and a budget is missed.
int build(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const BuildSettings& settings);

/// The one to report of several exit statuses: a defect inside (1 and unknown ones) before a lack of the machine (5),
/// bad input (3), wrong usage (2), a missed budget (4) and success (0).
int gravest_status(const std::vector<int>& statuses);

/// Writes the page over all assets of the pipeline, index.html of the output folder, where something was built there.
void write_index(const Pipeline& pipeline);

}  // namespace kiln
