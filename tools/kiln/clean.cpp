// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/clean.h"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <set>

#include "base/errors.h"
#include "kiln/build.h"
#include "kiln/gate/comparison_page.h"
#include "kiln/gate/junit.h"
#include "kiln/gate/markdown.h"
#include "kiln/output_lock.h"
#include "kiln/plan/plan.h"
#include "kiln/stage_state.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Tests for a hidden folder in which a killed stage left half-written files.
bool is_staging(const fs::path& path) { return path.filename().string().starts_with(".kiln-"); }

class Cleaner {
 public:
  explicit Cleaner(const Pipeline& pipeline)
      : folder_(pipeline.folder), output_(pipeline.output), notes_(output_ / ".kiln") {
    for (const MakeRule& rule : make_rules(pipeline)) {
      outputs_[rule.asset].insert(rule.run.outputs.begin(), rule.run.outputs.end());
      if (!rule.run.checkpoint.empty()) checkpoints_[rule.asset].push_back(rule.run.checkpoint);
    }
  }

  /// Lists the assets that have something in the output folder, or may have by the pipeline.
  std::set<std::string> assets() const {
    std::set<std::string> names;
    for (const auto& [name, files] : outputs_) names.insert(name);
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_ / notes_, error))
      if (entry.is_directory()) names.insert(entry.path().filename().string());
    return names;
  }

  void remove_asset(const std::string& name) {
    std::set<fs::path> files = outputs_[name];
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder_ / notes_ / name, error))
      if (const std::optional<StageState> state = load_state(entry.path()))
        for (const auto& [file, stamp] : state->outputs) files.insert(file);
    for (const fs::path& file : files) removed_ += fs::remove(folder_ / file, error) ? 1 : 0;
    for (const fs::path& checkpoint : checkpoints_[name]) fs::remove_all(folder_ / checkpoint, error);
    remove_leftovers(folder_ / output_ / name);
    fs::remove_all(folder_ / notes_ / name, error);
  }

  void remove_own_files() {
    std::error_code error;
    for (const char* name : {"Makefile", "index.html", junit_file, summary_file, comparison_file, comparison_data_file})
      removed_ += fs::remove(folder_ / output_ / name, error) ? 1 : 0;
    fs::remove_all(folder_ / output_ / comparison_folder, error);
    fs::remove_all(folder_ / notes_, error);
    fs::remove_all(folder_ / output_ / pilots_folder, error);
    fs::remove(folder_ / output_, error);  // removes the folder only if it is empty
  }

  int removed() const { return removed_; }
  const std::vector<fs::path>& kept() const { return kept_; }

 private:
  /// Removes folders that are empty now, from the inside out; notes which files are left.
  void remove_leftovers(const fs::path& folder) {
    std::error_code error;
    std::vector<fs::path> entries;
    for (const auto& entry : fs::directory_iterator(folder, error)) entries.push_back(entry.path());
    for (const fs::path& entry : entries)
      if (fs::is_directory(fs::symlink_status(entry, error))) {
        if (is_staging(entry))
          fs::remove_all(entry, error);
        else
          remove_leftovers(entry);
      } else {
        kept_.push_back(entry.lexically_normal());
      }
    fs::remove(folder, error);
  }

  fs::path folder_, output_, notes_;
  std::map<std::string, std::set<fs::path>> outputs_;
  std::map<std::string, std::vector<fs::path>> checkpoints_;
  int removed_ = 0;
  std::vector<fs::path> kept_;
};

}  // namespace

void clean(const Pipeline& pipeline, const std::vector<std::string>& names, bool quiet) {
  Cleaner cleaner(pipeline);
  const std::set<std::string> known = cleaner.assets();
  for (const std::string& name : names)
    if (!known.contains(name)) select_assets(pipeline, {name});  // throws, since the name is unknown
  std::error_code error;
  if (!fs::is_directory(pipeline.folder / pipeline.output, error)) {
    if (!quiet) std::fprintf(stderr, "kiln: nothing to remove\n");
    return;
  }
  const OutputLock lock(pipeline.folder / pipeline.output);
  const std::set<std::string> chosen = names.empty() ? known : std::set<std::string>(names.begin(), names.end());
  for (const std::string& name : chosen) cleaner.remove_asset(name);
  if (names.empty())
    cleaner.remove_own_files();
  else
    write_index(pipeline);
  for (const fs::path& file : cleaner.kept())
    std::fprintf(stderr, "kiln: kept %s, which Kiln did not make\n", file.c_str());
  if (!quiet) std::fprintf(stderr, "kiln: removed %d files\n", cleaner.removed());
}

}  // namespace kiln
