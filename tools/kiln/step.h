// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// Environment variables by which the driver instructs the steps that make runs for it.
namespace step_environment {
inline constexpr const char* events = "KILN_EVENTS";      ///< file that every step appends a StepEvent to
inline constexpr const char* messages = "KILN_MESSAGES";  ///< file descriptor for messages; make's own go elsewhere
/// Set if no other step runs at the same time, so that a progress bar may be drawn.
inline constexpr const char* alone = "KILN_ALONE";
}  // namespace step_environment

/// One run of a stage, as reported to the driver.
struct StepEvent {
  std::string asset;
  std::string stage;
  int status = 0;  ///< exit status, 1 if a signal ended it
  double seconds = 0;
};

/// Reads the events, in the order in which the steps ended.
std::vector<StepEvent> read_events(const std::filesystem::path& file);

/// Runs the stage of a plan for make if it has to run (reason_to_run); reports its time, or its failure. Runs in the
/// folder that relative paths start from. Returns the exit status for make: that of the stage, but 0 for a missed
/// budget, which leaves complete outputs and is for the driver to judge.
int run_step(const std::filesystem::path& plan_file, const std::filesystem::path& programs, int threads);

}  // namespace kiln
