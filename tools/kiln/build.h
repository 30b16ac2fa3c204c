// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/pipeline.h"
#include "kiln/rules.h"

namespace kiln {

struct BuildSettings {
  int jobs = 0;             ///< stages at a time; 0: as many as there are cores
  bool keep_going = false;  ///< whether other assets are built if one fails
  bool dry_run = false;     ///< whether to say what would run, and run and write nothing
  bool force = false;       ///< whether stages that are up to date run as well
  std::string until;        ///< last stage to run; empty: all stages run
  bool quiet = false;
  bool json = false;  ///< whether the outcome is written to stdout as one JSON object
};

/// Brings the assets up to date through make. Returns the exit status: that of the failed stage, the gravest if several
/// failed (gravest_status), 4 if everything is built and a budget is missed.
int build(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const BuildSettings& settings);

/// Picks the one of several exit statuses to report: a defect inside (1 and unknown ones) before a lack of the machine
/// (5), bad input (3), wrong usage (2), a missed budget (4) and success (0).
int gravest_status(const std::vector<int>& statuses);

/// Writes index.html, the page over all assets of the pipeline, into the output folder if something was built there.
void write_index(const Pipeline& pipeline);

}  // namespace kiln
