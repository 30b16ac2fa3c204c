// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/step.h"

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <unistd.h>

#include "base/errors.h"
#include "base/files.h"
#include "base/interruption.h"
#include "base/json.h"
#include "base/process.h"
#include "base/stopwatch.h"
#include "kiln/stage_state.h"
#include "report/judging.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// Ends as a process that does not catch the signal would, so that make and the driver see what happened.
void end_by(int signal) {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

}  // namespace

std::vector<StepEvent> read_events(const fs::path& file) {
  std::vector<StepEvent> events;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    const Json json = Json::parse(line);
    events.push_back({json.at("asset").get<std::string>(), json.at("stage").get<std::string>(),
                      json.at("status").get<int>(), json.at("seconds").get<double>()});
  }
  return events;
}

namespace {

/// Appends the event for the driver, if there is one; it counts runs by their events.
void tell_driver(const StepEvent& event) {
  const char* file = std::getenv(step_environment::events);
  if (file == nullptr) return;
  const Json json = {
      {"asset", event.asset}, {"stage", event.stage}, {"status", event.status}, {"seconds", event.seconds}};
  std::ofstream stream(file, std::ios::app);
  stream << json_text(json) + "\n" << std::flush;
  if (!stream) fail_to_write(file, "");
}

/// Tests whether a checkpoint belongs to this very run; removes one that does not. The state at a run's start is kept
/// beside the state.
bool may_resume(const StagePlan& plan, const StageState& begun) {
  std::error_code error;
  if (plan.run.checkpoint.empty()) return false;
  const fs::path file = plan.state.string() + ".begun";
  const std::optional<StageState> earlier = load_state(file);
  const auto same = [](const auto& a, const auto& b) { return a.first == b.first && a.second.hash == b.second.hash; };
  const bool resumes =
      earlier && earlier->key == begun.key && fs::is_directory(plan.run.checkpoint, error) &&
      std::equal(earlier->inputs.begin(), earlier->inputs.end(), begun.inputs.begin(), begun.inputs.end(), same);
  if (!resumes) fs::remove_all(plan.run.checkpoint, error);
  save_state(file, begun);
  return resumes;
}

/// Judges the report by new budgets without starting its program, which takes longer; returns whether that succeeded.
bool judge_report(const StagePlan& plan) {
  const auto page = std::find_if(plan.run.outputs.begin(), plan.run.outputs.end(),
                                 [](const fs::path& output) { return output.extension() == ".html"; });
  if (page == plan.run.outputs.end()) return false;
  std::vector<std::string> budgets;
  for (const std::string& word : plan.run.limits)
    if (word != "--budget") budgets.push_back(word);
  try {
    judge_anew(*page, budgets);
    return true;
  } catch (const std::exception&) {
    return false;  // the program will report what is wrong
  }
}

/// Makes the command, with the options that differ from run to run.
std::vector<std::string> command_of(const StagePlan& plan, const fs::path& programs, int threads) {
  std::vector<std::string> command = plan.run.whole_command();
  const bool is_own = command.front() == "kiln";
  command.front() = (programs / command.front()).string();
  if (!is_own) command.insert(command.end(), {"--threads", std::to_string(threads)});
  return command;
}

/// Runs the command, from its checkpoint if possible, with the asset's name before its messages if other stages run at
/// the same time.
ProcessEnd run_command(const StagePlan& plan, std::vector<std::string> command, bool resumes) {
  ProcessSettings settings;
  if (std::getenv(step_environment::alone) == nullptr)
    settings.on_error_line = [&](const std::string& line) {
      std::fprintf(stderr, "[%s] %s\n", plan.asset.c_str(), line.c_str());
    };
  if (!resumes) return run_process(command, settings);
  std::fprintf(stderr, "[%s] %s goes on from its checkpoint\n", plan.asset.c_str(), plan.run.name.c_str());
  command.emplace_back("--resume");
  const ProcessEnd end = run_process(command, settings);
  if (end.exit_status != static_cast<int>(ExitCode::bad_input)) return end;
  // The checkpoint is damaged, or of another backend.
  std::fprintf(stderr, "[%s] %s begins anew\n", plan.asset.c_str(), plan.run.name.c_str());
  std::error_code ignored;
  fs::remove_all(plan.run.checkpoint, ignored);
  command.pop_back();
  return run_process(command, settings);
}

}  // namespace

int run_step(const fs::path& plan_file, const fs::path& programs, int threads) {
  if (const char* messages = std::getenv(step_environment::messages)) dup2(std::atoi(messages), STDERR_FILENO);
  const StagePlan plan = load_plan(plan_file);
  const char* asset = plan.asset.c_str();
  const char* stage = plan.run.name.c_str();
  FileHashes hashes(".");
  std::optional<StageState> state = load_state(plan.state);
  const std::string reason = reason_to_run(plan, state, hashes);
  if (reason.empty()) return 0;
  const std::map<fs::path, FileStamp> inputs = stamps_of_inputs(plan, hashes);

  const Stopwatch watch;
  const bool resumes = may_resume(plan, {plan.key, inputs, {}});
  ProcessEnd end;
  if (reason != other_limits || !judge_report(plan))
    end = run_command(plan, command_of(plan, programs, threads), resumes);
  if (noted_signal() != 0) end_by(noted_signal());
  if (end.signal == SIGINT || end.signal == SIGTERM) end_by(end.signal);

  const int status = end.signal != 0 ? static_cast<int>(ExitCode::failed) : end.exit_status;
  const bool missed_budget = status == static_cast<int>(ExitCode::budget_missed);
  if (status == 0 || missed_budget) {
    try {
      save_state(plan.state, state_after(plan, inputs, "."));
    } catch (const std::exception&) {
      tell_driver({plan.asset, plan.run.name, static_cast<int>(ExitCode::failed), watch.seconds()});
      throw;
    }
    std::error_code ignored;
    fs::remove(plan.state.string() + ".begun", ignored);
  }
  tell_driver({plan.asset, plan.run.name, status, watch.seconds()});
  if (status == 0 || missed_budget)
    std::fprintf(stderr, "[%s] %s ... %.1f s\n", asset, stage, watch.seconds());
  else if (end.signal != 0)
    std::fprintf(stderr, "kiln: asset '%s', stage '%s' failed (ended by signal %d)\n", asset, stage, end.signal);
  else
    std::fprintf(stderr, "kiln: asset '%s', stage '%s' failed (exit status %d)\n", asset, stage, status);
  return missed_budget && std::getenv(step_environment::events) != nullptr ? 0 : status;
}

}  // namespace kiln
