#pragma once

#include <string>
#include <vector>

#include "kiln/makefile.h"
#include "kiln/pipeline.h"

namespace kiln {

struct BuildSettings {
  int jobs = 0;             ///< stages at a time; 0: as many as there are cores
  bool keep_going = false;  ///< build the other assets where one fails
  bool dry_run = false;     ///< say what would run, run and write nothing
  bool quiet = false;
};

/// Brings the assets up to date through make. Returns the exit status: that of the failed stage, the gravest
/// where several failed (see gravest_status), 4 where all is built and a budget is missed.
int build(const Pipeline& pipeline, const std::vector<const Asset*>& assets, const BuildSettings& settings);

/// The one to report of several exit statuses: a defect inside (1 and unknown ones) before a lack of the machine (5),
/// bad input (3), wrong usage (2), a missed budget (4) and success (0).
int gravest_status(const std::vector<int>& statuses);

/// The rules of every asset of the pipeline. `programs` is where the stages' executables are.
std::vector<MakeRule> make_rules(const Pipeline& pipeline);

/// What a rule's stamp holds: everything that makes the command give another result. It names the programs without
/// their folder, but by content, so that a moved build does not make all anew and a changed one does.
std::string stamp_text(const StageRun& run, const std::filesystem::path& programs);

}  // namespace kiln
