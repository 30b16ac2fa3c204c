// SPDX-License-Identifier: MIT
#include "base/command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cctype>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <fmt/format.h>
#include <fstream>
#include <memory>
#include <new>
#include <sys/resource.h>
#include <thread>

#include "base/errors.h"
#include "base/file_names.h"
#include "base/hashes.h"
#include "base/help_pages.h"
#include "base/interruption.h"
#include "base/json.h"
#include "base/process.h"
#include "base/progress_bar.h"
#include "base/stopwatch.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

void require_exists(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw BadInput(path.string(), "does not exist", "an input file", "check the path");
}

/// Tells whether everything printed on stdout was written; prints the reason if not.
bool stdout_is_whole(const std::string& program) {
  errno = 0;
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  std::fprintf(stderr, "%s: stdout cannot be written (%s)\n", program.c_str(), std::strerror(errno));
  return false;
}

int fail(const std::string& program, ExitCode code, const std::string& message) {
  std::fprintf(stderr, "%s: %s\n", program.c_str(), message.c_str());
  return static_cast<int>(code);
}

}  // namespace

CommandLine::CommandLine(std::string program, const std::string& purpose)
    : program_(std::move(program)),
      stage_(program_.substr(program_.find('-') + 1)),
      app_(std::make_unique<CLI::App>(purpose, program_)) {
  app_->set_version_flag("--version", std::string(KILN_VERSION));
  app_->get_formatter()->column_width(38);
  add_help_forms(*app_);
  app_->add_flag("--json", json_, "Print the result as one JSON object on stdout")->group("Common");
  app_->add_flag("--quiet", quiet_, "Print warnings and errors only")->group("Common");
  app_->add_option("--threads", threads_, "Threads, 0 for all cores (default 0; 0 to 1024)")
      ->check(CLI::Range(0, 1024))
      ->group("Common");
  app_->add_option("--seed", seed_, "Seed of everything random (default 1; 0 to 2147483647)")
      ->check(CLI::Range(0, 2147483647))
      ->group("Common");
}

CommandLine::~CommandLine() = default;

bool CommandLine::given(const std::string& name) const { return app_->count("--" + name) > 0; }

void CommandLine::input(const std::string& name, fs::path& path, const std::string& help) {
  app_->add_option(name, path, help)->required();
  inputs_.push_back(&path);
}

void CommandLine::optional_input(const std::string& name, fs::path& path, const std::string& help) {
  app_->add_option(name, path, help);
  inputs_.push_back(&path);
}

void CommandLine::inputs(const std::string& name, std::vector<fs::path>& paths, const std::string& help) {
  app_->add_option(name, paths, help)->required();
  input_lists_.push_back(&paths);
}

void CommandLine::output(fs::path& path, const std::string& help) {
  app_->add_option("-o,--output", path, help)->required();
}

void CommandLine::optional_output(fs::path& path, const std::string& help) {
  app_->add_option("-o,--output", path, help);
}

void CommandLine::input_option(const std::string& name, fs::path& path, const std::string& help) {
  app_->add_option("--" + name, path, help);
  inputs_.push_back(&path);
}

void CommandLine::input_option(const std::string& name, std::vector<fs::path>& paths, const std::string& help) {
  // Take one path per option, so that a positional input after it is not swallowed.
  app_->add_option("--" + name, paths, help)->expected(1)->take_all();
  input_lists_.push_back(&paths);
}

void CommandLine::list_option(const std::string& name, std::vector<std::string>& texts, const std::string& heading,
                              const std::string& help) {
  app_->add_option("--" + name, texts, help)->expected(1)->take_all()->type_name("")->group(heading);
}

void CommandLine::paths(const std::string& name, std::vector<fs::path>& paths, const std::string& help) {
  app_->add_option(name, paths, help)->required();
}

void CommandLine::text_option(const std::string& name, std::string& text, const std::string& heading,
                              const std::string& help) {
  app_->add_option("--" + name, text, help)->type_name("")->group(heading);
}

void CommandLine::number_option(const std::string& name, double& number, const std::string& heading,
                                const std::string& help) {
  app_->add_option("--" + name, number, help)
      ->check(CLI::Validator(CLI::NonNegativeNumber).description(""))
      ->type_name("")
      ->group(heading);
}

void CommandLine::flag(const std::string& name, bool& given, const std::string& heading, const std::string& help) {
  app_->add_flag("--" + name, given, help)->group(heading);
}

void CommandLine::footer(const std::string& text) { app_->footer(text); }

void CommandLine::options(const std::string& heading, const OptionSet& options) {
  option_sets_.push_back(options);
  for (const Option& option : option_sets_.back().options()) {
    const Json value = option.get();
    if (option.is_switch) {
      app_->add_flag_callback(
              "--" + option.name, [set = option.set] { set("true"); }, option.help)
          ->group(heading);
      continue;
    }
    const std::string shown = value.is_string() ? value.get<std::string>() : value.dump();
    app_->add_option_function<std::string>(
            "--" + option.name,
            [set = option.set](const std::string& text) {
              try {
                set(text);
              } catch (const WrongUsage& error) {
                throw CLI::ValidationError(std::string("--") + error.what());
              }
            },
            fmt::format("{} (default {}; {})", option.help, shown.empty() ? "none" : shown, option.value_range))
        ->type_name("")
        ->group(heading);
  }
}

std::vector<std::string> CommandLine::joined_values(int argc, char** argv) const {
  const auto takes = [&](const std::string& word, const std::string& value) {
    for (const OptionSet& set : option_sets_)
      for (const Option& option : set.options())
        if (word == "--" + option.name && !option.is_switch) return option.value_range.find(value) != std::string::npos;
    return false;
  };
  std::vector<std::string> words;
  for (int k = 1; k < argc; ++k) {
    const std::string word = argv[k], next = k + 1 < argc ? argv[k + 1] : "";
    const bool looks_like_option = next.size() == 2 && next[0] == '-' && std::isalpha(next[1]) != 0;
    if (looks_like_option && takes(word, next)) {
      words.push_back(word + "=" + next);
      ++k;
    } else {
      words.push_back(word);
    }
  }
  return words;
}

void CommandLine::parse(int argc, char** argv) {
  try {
    std::vector<std::string> words = joined_values(argc, argv);
    std::reverse(words.begin(), words.end());  // CLI11 takes them off the end
    app_->parse(words);
  } catch (const CLI::Success& asked_for_help) {
    app_->exit(asked_for_help);
    throw;
  }
  if (threads_ == 0) threads_ = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
  thread_limit_.emplace(static_cast<std::size_t>(threads_));
  for (const fs::path* path : inputs_)
    if (!path->empty()) require_exists(*path);
  for (const auto* list : input_lists_)
    for (const fs::path& path : *list) require_exists(path);
}

void CommandLine::also_read(const std::vector<fs::path>& files) {
  also_read_.insert(also_read_.end(), files.begin(), files.end());
}

ProgressFunction CommandLine::progress(const std::string& label) const {
  return [bar = std::make_shared<ProgressBar>(label, quiet_)](double fraction) { (*bar)(fraction); };
}

void CommandLine::say(const std::string& line) const {
  if (!quiet_) std::fprintf(stderr, "%s: %s\n", program_.c_str(), line.c_str());
}

void CommandLine::warn(const std::vector<std::string>& warnings, const std::vector<std::string>& said) {
  const auto has = [](const std::vector<std::string>& list, const std::string& warning) {
    return std::find(list.begin(), list.end(), warning) != list.end();
  };
  for (const std::string& warning : warnings) {
    if (has(warnings_, warning)) continue;
    warnings_.push_back(warning);
    if (!has(said, warning)) std::fprintf(stderr, "%s: WARNING: %s\n", program_.c_str(), warning.c_str());
  }
}

Json CommandLine::result(double seconds, const Json& metrics) const {
  Json settings = Json::object();
  for (const OptionSet& set : option_sets_) settings.update(set.to_json());
  settings["seed"] = seed_;
  Json inputs = Json::object();
  const auto add = [&](const fs::path& path) {
    if (!path.empty() && fs::is_regular_file(path)) inputs[text_of_path(path)] = hash_file(path);
  };
  for (const fs::path* path : inputs_) add(*path);
  for (const auto* list : input_lists_)
    for (const fs::path& path : *list) add(path);
  for (const fs::path& path : also_read_) add(path);
  Json result = {{"stage", stage_},
                 {"version", KILN_VERSION},
                 {"settings", settings},
                 {"inputs", inputs},
                 {"seconds", seconds},
                 {"cpu_seconds", cpu_seconds()},
                 {"peak_memory_bytes", peak_memory_bytes()},
                 {"warnings", warnings_}};
  result.update(metrics);
  return result;
}

void CommandLine::finish(OutputSet& outputs, const Json& result) const {
  Json record = result;
  record["outputs"] = Json::object();
  for (const std::string& name : outputs.names())
    record["outputs"][text_of_path(name)] = hash_file(outputs.staging() / name);
  outputs.add_text(stage_ + ".json", json_text(record, 2) + "\n");
  finish_without_record(outputs, record);
}

void CommandLine::finish_without_record(OutputSet& outputs, const Json& result) const {
  throw_if_interrupted();
  outputs.commit();
  finish_without_output(result);
}

void CommandLine::finish_without_output(const Json& result) const {
  if (json_) std::printf("%s\n", json_text(result).c_str());
}

long long peak_memory_bytes() {
  // Linux counts the memory of this program alone there; ru_maxrss begins with what the process that started it had.
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.starts_with("VmHWM:")) return std::strtoll(line.c_str() + 6, nullptr, 10) * 1024;
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<long long>(usage.ru_maxrss) * 1024;
}

int run_program(const std::string& program, const std::function<void()>& body) {
  stop_on_signals();
  try {
    body();
    return static_cast<int>(stdout_is_whole(program) ? ExitCode::done : ExitCode::failed);
  } catch (const CLI::Success&) {  // --help or --version, printed by parse()
    return static_cast<int>(stdout_is_whole(program) ? ExitCode::done : ExitCode::failed);
  } catch (const CLI::ParseError& error) {
    return fail(program, ExitCode::wrong_usage, std::string(error.what()) + "; see " + program + " --help");
  } catch (const WrongUsage& error) {
    return fail(program, ExitCode::wrong_usage, std::string(error.what()) + "; see " + program + " --help");
  } catch (const BadInput& error) {
    return fail(program, ExitCode::bad_input, error.what());
  } catch (const BudgetMissed& error) {
    return fail(program, ExitCode::budget_missed, error.what());
  } catch (const MachineLacks& error) {
    return fail(program, ExitCode::machine_lacks, error.what());
  } catch (const Interrupted&) {
    std::fprintf(stderr, "%s: interrupted, nothing was written\n", program.c_str());
    // End by the signal itself, so that make and the shell see what happened.
    std::signal(noted_signal(), SIG_DFL);
    std::raise(noted_signal());
    return static_cast<int>(ExitCode::failed);
  } catch (const DiskFull& error) {
    return fail(program, ExitCode::failed, error.what());
  } catch (const std::bad_alloc&) {
    return fail(program, ExitCode::failed, "ran out of memory");
  } catch (const std::filesystem::filesystem_error& error) {
    const bool full = error.code() == std::errc::no_space_on_device;
    return fail(program, ExitCode::failed,
                full ? error.path2().string() +
                           ": cannot be written, the disk is full; free some room, or choose "
                           "another output"
                     : std::string("failed inside: ") + error.what());
  } catch (const std::exception& error) {
    return fail(program, ExitCode::failed, std::string("failed inside: ") + error.what());
  }
}

}  // namespace kiln
