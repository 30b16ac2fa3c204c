// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "kiln/stages.h"

namespace kiln {

/// A file's content, and what the file system said of it when that was read. While that is as it was, so is the
/// content.
struct FileStamp {
  std::string hash;  ///< XXH3, 128 bits
  std::int64_t bytes = 0;
  std::int64_t changed = 0;   ///< of the inode, nanoseconds; no program can set it
  std::int64_t modified = 0;  ///< nanoseconds
  std::uint64_t inode = 0;    ///< 0: it was so young when it was read that a change might leave no trace
};

/// The hashes of files, each read once, and not at all where an earlier stamp still holds.
class FileHashes {
 public:
  /// `folder` is where relative paths start from.
  explicit FileHashes(std::filesystem::path folder) : folder_(std::move(folder)) {}

  /// The stamp of a file as it is now; nothing where there is no such file. `earlier` may be null.
  std::optional<FileStamp> stamp(const std::filesystem::path& file, const FileStamp* earlier = nullptr);

  /// Bytes of all files that had to be read.
  std::int64_t bytes_read() const { return bytes_read_; }

 private:
  std::filesystem::path folder_;
  std::map<std::filesystem::path, FileStamp> known_;
  std::int64_t bytes_read_ = 0;
};

/// A stage of an asset as the Makefile has it run.
struct StagePlan {
  std::string asset;
  StageRun run;
  std::string key;              ///< what makes the command give another result, its limits aside: stamp_text()
  std::filesystem::path state;  ///< the file of its StageState
};

void save_plan(const std::filesystem::path& file, const StagePlan& plan);
StagePlan load_plan(const std::filesystem::path& file);

/// What a stage last read and made, by content. It is kept in the output folder's .kiln/, apart from the record, which
/// says what the stage did.
struct StageState {
  std::string key;
  std::map<std::filesystem::path, FileStamp> inputs, outputs;
  std::vector<std::string> limits = {};
};

/// Nothing where there is none that can be read.
std::optional<StageState> load_state(const std::filesystem::path& file);
void save_state(const std::filesystem::path& file, const StageState& state);

/// Why a stage has to run, in a few words; empty where it does not: its command, and the content of all that it read
/// and made, are as they were. `other_limits` where nothing but its limits is not. Stamps in `state` are brought up to
/// date.
std::string reason_to_run(const StagePlan& plan, std::optional<StageState>& state, FileHashes& hashes);

inline constexpr const char* other_limits = "its budgets have changed";

/// What a stage will read, before it runs.
std::map<std::filesystem::path, FileStamp> stamps_of_inputs(const StagePlan& plan, FileHashes& hashes);

/// The state after a run that succeeded: `inputs` as they were before, those that the record names besides, and the
/// outputs. The record's outputs are all that was made; where there is no record, the plan's are.
StageState state_after(const StagePlan& plan, std::map<std::filesystem::path, FileStamp> inputs,
                       const std::filesystem::path& folder);

}  // namespace kiln
