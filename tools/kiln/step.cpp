#include "kiln/step.h"

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <unistd.h>

#include "base/stopwatch.h"
#include "base/errors.h"
#include "base/outputs.h"
#include "base/process.h"
#include "base/progress.h"

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
  for (StepEvent event; stream >> event.asset >> event.stage >> event.status;) events.push_back(event);
  return events;
}

int run_step(const std::string& asset, const std::string& stage, std::vector<std::string> command, int threads) {
  if (const char* messages = std::getenv(step_environment::messages)) dup2(std::atoi(messages), STDERR_FILENO);
  if (stage != "extract" && stage != "square") command.insert(command.end(), {"--threads", std::to_string(threads)});
  ProcessSettings settings;
  if (std::getenv(step_environment::alone) == nullptr)
    settings.on_error_line = [&](const std::string& line) {
      std::fprintf(stderr, "[%s] %s\n", asset.c_str(), line.c_str());
    };

  const Stopwatch watch;
  const ProcessEnd end = run_process(command, settings);
  if (noted_signal() != 0) end_by(noted_signal());
  if (end.signal == SIGINT || end.signal == SIGTERM) end_by(end.signal);

  const int status = end.signal != 0 ? static_cast<int>(ExitCode::failed) : end.exit_status;
  const bool missed_budget = status == static_cast<int>(ExitCode::budget_missed);
  const char* events = std::getenv(step_environment::events);
  if (events != nullptr) std::ofstream(events, std::ios::app) << fmt::format("{} {} {}\n", asset, stage, status);
  if (status == 0 || missed_budget)
    std::fprintf(stderr, "[%s] %s ... %.1f s\n", asset.c_str(), stage.c_str(), watch.seconds());
  else if (end.signal != 0)
    std::fprintf(stderr, "kiln: asset '%s', stage '%s' failed (ended by signal %d)\n", asset.c_str(), stage.c_str(),
                 end.signal);
  else
    std::fprintf(stderr, "kiln: asset '%s', stage '%s' failed (exit status %d)\n", asset.c_str(), stage.c_str(),
                 status);
  return missed_budget && events != nullptr ? 0 : status;
}

void extract_member(const fs::path& archive, const std::string& member, const fs::path& mesh) {
  OutputSet outputs(folder_of(mesh));
  const fs::path staged = outputs.add(mesh.filename().string());
  const fs::path staging = staged.parent_path();
  // The time of the extraction, not that in the archive, which would be older than what make compares it with.
  const ProcessEnd end = run_process({"tar", "--extract", "--touch", "--no-same-owner", "--file", archive.string(),
                                      "--directory", staging.string(), "--", member});
  throw_if_interrupted();
  if (!end.succeeded() || !fs::is_regular_file(staging / member))
    throw BadInput(archive.string(), "has no file '" + member + "' that tar can extract", "a tar file with that member",
                   "check archive and member");
  if (staging / member != staged) fs::rename(staging / member, staged);
  outputs.commit();
}

void write_square(double half_size, const fs::path& mesh) {
  OutputSet outputs(folder_of(mesh));
  outputs.add_text(mesh.filename().string(), fmt::format("v {1} 0 {0}\nv {0} 0 {0}\nv {0} 0 {1}\nv {1} 0 {1}\n"
                                                         "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 2/2 3/3 4/4\n",
                                                         half_size, -half_size));
  outputs.commit();
}

}  // namespace kiln
