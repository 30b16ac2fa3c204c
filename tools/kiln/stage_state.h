// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// Hash of a file's content, and what the file system reported when it was read. While that report is unchanged, so is
/// the content.
struct FileStamp {
  std::string hash;  ///< XXH3, 128 bits
  std::int64_t bytes = 0;
  std::int64_t changed = 0;   ///< change time of the inode, nanoseconds; no program can set it
  std::int64_t modified = 0;  ///< nanoseconds
  std::uint64_t inode = 0;    ///< 0: the file was too young when read, so that a later change might leave no trace
};

/// Hashes of files; each file is read once, and not at all while an earlier stamp holds.
class FileHashes {
 public:
  /// Uses `folder` as the start of relative paths.
  explicit FileHashes(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// Returns the current stamp of a file; nothing if it does not exist. `earlier` may be null.
  std::optional<FileStamp> stamp(const std::filesystem::path& file, const FileStamp* earlier = nullptr);

  /// Returns the number of bytes of all files that had to be read.
  std::int64_t bytes_read() const { return bytes_read_; }

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, FileStamp> known_;
  std::int64_t bytes_read_ = 0;
};

/// A stage of an asset, as the Makefile has it run.
struct StagePlan {
  std::string asset;
  StageRun run;
  std::string key;              ///< what determines the result of the command, except its limits: stamp_text()
  std::filesystem::path state;  ///< file of its StageState
};

void save_plan(const std::filesystem::path& file, const StagePlan& plan);
StagePlan load_plan(const std::filesystem::path& file);

/// Hashes of what a stage last read and made. Kept in the output folder's .kiln/, apart from the record, which says
/// what the stage did.
struct StageState {
  std::string key;
  std::map<std::filesystem::path, FileStamp> inputs, outputs;
  std::vector<std::string> limits = {};
};

/// Reads a state; nothing if there is none that can be read.
std::optional<StageState> load_state(const std::filesystem::path& file);
void save_state(const std::filesystem::path& file, const StageState& state);

/// Says in a few words why a stage has to run; empty if it does not, because its command and the content of all inputs
/// and outputs are unchanged; `other_limits` if only its limits have changed. Updates the stamps in `state`.
std::string reason_to_run(const StagePlan& plan, std::optional<StageState>& state, FileHashes& hashes);

inline constexpr const char* other_limits = "its budgets have changed";

/// Stamps the inputs of a stage before it runs.
std::map<std::filesystem::path, FileStamp> stamps_of_inputs(const StagePlan& plan, FileHashes& hashes);

/// Makes the state after a successful run from `inputs`, as they were before it, the further inputs that the record
/// names, and the outputs: those of the record or, without a record, the plan's.
StageState state_after(const StagePlan& plan, std::map<std::filesystem::path, FileStamp> inputs,
                       const std::filesystem::path& folder);

}  // namespace kiln
