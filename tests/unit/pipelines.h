// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "base/errors.h"
#include "kiln/build.h"
#include "kiln/pipeline.h"
#include "scratch.h"

namespace kiln {

/// Writes a pipeline into a folder and loads it.
inline Pipeline pipeline_in(const std::filesystem::path& folder, const std::string& text) {
  std::ofstream(folder / "pipeline.yaml") << text;
  return load_pipeline(folder / "pipeline.yaml");
}

/// Loads a pipeline from its text.
inline Pipeline pipeline_of(const std::string& text) {
  const Scratch scratch;  // of this test alone: CTest runs several at once
  return pipeline_in(scratch.folder(), text);
}

/// Returns the message by which a pipeline is refused; empty if it is not.
inline std::string refusal(const std::string& text) {
  try {
    pipeline_of(text);
  } catch (const BadInput& error) {
    return error.what();
  }
  return "";
}

/// Finds how a stage of an asset is run.
inline const StageRun& run_of(const std::vector<MakeRule>& rules, const std::string& asset, const std::string& stage) {
  const auto found = std::find_if(rules.begin(), rules.end(),
                                  [&](const MakeRule& rule) { return rule.asset == asset && rule.run.name == stage; });
  if (found == rules.end()) throw std::runtime_error("no such rule");
  return found->run;
}

/// Returns the word after an option of a command; empty if there is none.
inline std::string value_after(const std::vector<std::string>& command, const std::string& option) {
  const auto found = std::find(command.begin(), command.end(), option);
  return found == command.end() || found + 1 == command.end() ? "" : *(found + 1);
}

/// Tells whether a path is among others.
inline bool contains(const std::vector<std::filesystem::path>& paths, const char* path) {
  return std::find(paths.begin(), paths.end(), path) != paths.end();
}

}  // namespace kiln
