// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace kiln {

/// What the driver tells the steps that make runs for it, through the environment.
namespace step_environment {
inline constexpr const char* events = "KILN_EVENTS";      ///< file that every step appends a StepEvent to
inline constexpr const char* messages = "KILN_MESSAGES";  ///< file descriptor for messages; make's own go elsewhere
inline constexpr const char* alone = "KILN_ALONE";  ///< set: no other step runs beside, so a progress bar may be drawn
}  // namespace step_environment

/// One run of a stage, as the driver is told.
struct StepEvent {
  std::string asset;
  std::string stage;
  int status = 0;  ///< exit status, 1 where a signal ended it
  double seconds = 0;
};

/// The events in the order in which the steps ended.
std::vector<StepEvent> read_events(const std::filesystem::path& file);

/// Runs the stage of a plan for make where it has to (reason_to_run): says how long it took, or that it failed. Runs in
/// the folder that relative paths start from. Returns what make is to see: the exit status, but 0 for a missed budget,
/// which leaves whole outputs and is the driver's to judge.
int run_step(const std::filesystem::path& plan_file, const std::filesystem::path& programs, int threads);

/// Writes `member` of a tar file to `mesh`. Throws BadInput where there is none.
void extract_member(const std::filesystem::path& archive, const std::string& member, const std::filesystem::path& mesh);

/// Whether a tar file has that member, as it is written.
bool has_member(const std::filesystem::path& archive, const std::string& member);

/// Writes a square about the origin of the xz plane, facing +Y, as an OBJ file with texture coordinates.
void write_square(double half_size, const std::filesystem::path& mesh);

}  // namespace kiln
