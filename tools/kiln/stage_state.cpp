// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/stage_state.h"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <sys/stat.h>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/files.h"
#include "base/hashes.h"
#include "base/json.h"
#include "kiln/text_file.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

constexpr std::int64_t nanoseconds_of_second = 1'000'000'000;

/// Coarsest resolution of file times (FAT: two seconds): a file that changes later within it looks unchanged.
constexpr std::int64_t youngest = 2 * nanoseconds_of_second;

std::int64_t nanoseconds(const timespec& time) { return time.tv_sec * nanoseconds_of_second + time.tv_nsec; }

Json to_json(const std::map<fs::path, FileStamp>& files) {
  Json json = Json::object();
  for (const auto& [file, stamp] : files)
    json[text_of_path(file)] = {stamp.hash, stamp.bytes, stamp.changed, stamp.modified, stamp.inode};
  return json;
}

std::map<fs::path, FileStamp> stamps_of(const Json& json) {
  std::map<fs::path, FileStamp> files;
  for (const auto& [file, stamp] : json.items())
    files[path_of_text(file)] = {stamp.at(0).get<std::string>(), stamp.at(1).get<std::int64_t>(),
                                 stamp.at(2).get<std::int64_t>(), stamp.at(3).get<std::int64_t>(),
                                 stamp.at(4).get<std::uint64_t>()};
  return files;
}

template <class Words>
Json texts_of(const Words& words) {
  Json texts = Json::array();
  for (const auto& word : words) texts.push_back(text_of_path(word));
  return texts;
}

std::vector<fs::path> paths_of(const Json& json) {
  std::vector<fs::path> paths;
  for (const Json& text : json) paths.push_back(path_of_text(text.get<std::string>()));
  return paths;
}

std::vector<std::string> words_of(const Json& json) {
  std::vector<std::string> words;
  for (const Json& text : json) words.push_back(path_of_text(text.get<std::string>()).string());
  return words;
}

/// Reads the record of a stage; null if there is none.
Json record_of(const StagePlan& plan, const fs::path& folder) {
  std::error_code error;
  const fs::path file = folder / plan.run.outputs.front();
  if (file.extension() != ".json" || !fs::is_regular_file(file, error)) return {};
  return Json::parse(read_text(file), nullptr, false);
}

/// Tests whether a file of a state is unchanged.
bool holds(const fs::path& file, FileStamp& stamp, FileHashes& hashes, std::string& reason) {
  const std::optional<FileStamp> now = hashes.stamp(file, &stamp);
  if (!now)
    reason = text_of_path(file) + " is missing";
  else if (now->hash != stamp.hash)
    reason = text_of_path(file) + " has changed";
  else
    stamp = *now;
  return reason.empty();
}

}  // namespace

std::optional<FileStamp> FileHashes::stamp(const fs::path& file, const FileStamp* earlier) {
  if (const auto found = known_.find(file); found != known_.end()) return found->second;
  const fs::path path = folder_ / file;
  struct stat status = {};
  if (stat(path.c_str(), &status) != 0 || !S_ISREG(status.st_mode)) return std::nullopt;
  FileStamp now{"", status.st_size, nanoseconds(status.st_ctim), nanoseconds(status.st_mtim), status.st_ino};
  if (earlier != nullptr && earlier->inode == now.inode && earlier->bytes == now.bytes &&
      earlier->changed == now.changed && earlier->modified == now.modified) {
    now.hash = earlier->hash;
  } else {
    timespec clock = {};
    clock_gettime(CLOCK_REALTIME, &clock);
    if (nanoseconds(clock) - std::max(now.changed, now.modified) < youngest) now.inode = 0;
    now.hash = hash_file(path);
    bytes_read_ += now.bytes;
  }
  return known_[file] = now;
}

void save_plan(const fs::path& file, const StagePlan& plan) {
  const StageRun& run = plan.run;
  const Json json = {{"asset", plan.asset},
                     {"stage", run.name},
                     {"command", texts_of(run.command)},
                     {"inputs", texts_of(run.inputs)},
                     {"outputs", texts_of(run.outputs)},
                     {"checkpoint", text_of_path(run.checkpoint)},
                     {"limits", texts_of(run.limits)},
                     {"key", text_of_path(plan.key)},
                     {"state", text_of_path(plan.state)}};
  write_if_changed(file, json_text(json, 1) + "\n");
}

StagePlan load_plan(const fs::path& file) {
  const Json json = Json::parse(read_text(file), nullptr, false);
  try {
    StagePlan plan;
    plan.asset = json.at("asset").get<std::string>();
    plan.run.name = json.at("stage").get<std::string>();
    plan.run.command = words_of(json.at("command"));
    plan.run.inputs = paths_of(json.at("inputs"));
    plan.run.outputs = paths_of(json.at("outputs"));
    plan.run.limits = words_of(json.at("limits"));
    plan.run.checkpoint = path_of_text(json.at("checkpoint").get<std::string>());
    plan.key = path_of_text(json.at("key").get<std::string>()).string();
    plan.state = path_of_text(json.at("state").get<std::string>());
    return plan;
  } catch (const Json::exception&) {
    throw BadInput(file.string(), "is no plan of a stage", "what kiln build writes", "run kiln build");
  }
}

std::optional<StageState> load_state(const fs::path& file) {
  std::error_code error;
  if (!fs::is_regular_file(file, error)) return std::nullopt;
  const Json json = Json::parse(read_text(file), nullptr, false);
  try {
    return StageState{path_of_text(json.at("key").get<std::string>()).string(), stamps_of(json.at("inputs")),
                      stamps_of(json.at("outputs")), words_of(json.at("limits"))};
  } catch (const Json::exception&) {
    return std::nullopt;  // truncated, or of another version: as if the stage had not run
  }
}

void save_state(const fs::path& file, const StageState& state) {
  const Json json = {{"key", text_of_path(state.key)},
                     {"limits", texts_of(state.limits)},
                     {"inputs", to_json(state.inputs)},
                     {"outputs", to_json(state.outputs)}};
  write_if_changed(file, json_text(json, 1) + "\n");
}

std::string reason_to_run(const StagePlan& plan, std::optional<StageState>& state, FileHashes& hashes) {
  if (!state) return "it has not run";
  if (state->key != plan.key) return "its command or programs have changed";
  for (const fs::path& input : plan.run.inputs)
    if (!state->inputs.contains(input)) return text_of_path(input) + " is new to it";
  for (const fs::path& output : plan.run.outputs)
    if (!state->outputs.contains(output)) return text_of_path(output) + " is missing";
  std::string reason;
  for (auto* files : {&state->inputs, &state->outputs})
    for (auto& [file, stamp] : *files)
      if (!holds(file, stamp, hashes, reason)) return reason;
  return state->limits == plan.run.limits ? "" : other_limits;
}

std::map<fs::path, FileStamp> stamps_of_inputs(const StagePlan& plan, FileHashes& hashes) {
  std::map<fs::path, FileStamp> stamps;
  for (const fs::path& input : plan.run.inputs)
    if (const std::optional<FileStamp> stamp = hashes.stamp(input)) stamps[input] = *stamp;
  return stamps;
}

StageState state_after(const StagePlan& plan, std::map<fs::path, FileStamp> inputs, const fs::path& folder) {
  FileHashes hashes(folder);
  StageState state{plan.key, std::move(inputs), {}, plan.run.limits};
  const Json record = record_of(plan, folder);
  const auto add = [&](std::map<fs::path, FileStamp>& files, const fs::path& file) {
    if (files.contains(file)) return;
    if (const std::optional<FileStamp> stamp = hashes.stamp(file)) files[file] = *stamp;
  };
  for (const fs::path& output : plan.run.outputs) add(state.outputs, output);
  if (!record.is_object()) return state;
  // Adds textures and material libraries, which only the stage knows: the record lists what was read.
  const Json read = record.value("inputs", Json::object()), made = record.value("outputs", Json::object());
  for (const auto& [name, hash] : read.items()) {
    const fs::path file = path_of_text(name).lexically_normal();
    if (state.inputs.contains(file)) continue;
    add(state.inputs, file);
    if (const auto found = state.inputs.find(file); found != state.inputs.end() && found->second.hash != hash)
      found->second = {hash.get<std::string>(), 0, 0, 0, 0};
  }
  for (const auto& [name, hash] : made.items())
    add(state.outputs, folder_of(plan.run.outputs.front()) / path_of_text(name));
  return state;
}

}  // namespace kiln
