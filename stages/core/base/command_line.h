// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/options.h"
#include "base/outputs.h"
#include "base/parallel.h"
#include "base/progress.h"

namespace CLI {  // NOLINT(readability-identifier-naming): the library's own name
class App;
}

namespace kiln {

/// The command line that all stages share: `kiln-<stage> INPUT... -o OUTPUT [options]` with --json, --quiet,
/// --threads and --seed, the result as JSON, and the exit statuses.
class CommandLine {
 public:
  /// `program` is "kiln-<stage>".
  CommandLine(std::string program, const std::string& purpose);
  ~CommandLine();

  /// Adds a positional input, an existing file or folder; the hash of a file goes into the result.
  void input(const std::string& name, std::filesystem::path& path, const std::string& help);

  /// Adds a positional input that may be left out; `path` is what it is then.
  void optional_input(const std::string& name, std::filesystem::path& path, const std::string& help);

  /// Adds one or more positional inputs.
  void inputs(const std::string& name, std::vector<std::filesystem::path>& paths, const std::string& help);

  /// Adds `-o OUTPUT`, required.
  void output(std::filesystem::path& path, const std::string& help);

  /// Adds `-o OUTPUT` for programs that may run without; `path` stays as it is then.
  void optional_output(std::filesystem::path& path, const std::string& help);

  /// Adds an optional input named by an option: `--detail FOLDER`.
  void input_option(const std::string& name, std::filesystem::path& path, const std::string& help);
  void input_option(const std::string& name, std::vector<std::filesystem::path>& paths, const std::string& help);

  /// Adds files named by inputs or settings, after parse(); their hashes go into the result like those of inputs.
  void also_read(const std::vector<std::filesystem::path>& files);

  /// Adds `--name TEXT`, which may be repeated, under a heading of --help.
  void list_option(const std::string& name, std::vector<std::string>& texts, const std::string& heading,
                   const std::string& help);

  /// Adds one or more positional paths, which need not exist and are not in the result.
  void paths(const std::string& name, std::vector<std::filesystem::path>& paths, const std::string& help);

  /// Adds `--name TEXT`, `--name NUMBER` (0 or more) or the switch `--name`, under a heading of --help. They say how to
  /// run, so they are not among the result's settings.
  void text_option(const std::string& name, std::string& text, const std::string& heading, const std::string& help);
  void number_option(const std::string& name, double& number, const std::string& heading, const std::string& help);
  void flag(const std::string& name, bool& given, const std::string& heading, const std::string& help);

  /// Adds the settings of the stage, under a heading of --help.
  void options(const std::string& heading, const OptionSet& options);

  /// Adds a text at the end of --help.
  void footer(const std::string& text);

  /// Tells, after parse(), whether `--name` was given.
  bool given(const std::string& name) const;

  /// Parses the arguments and limits the number of threads. Throws CLI::ParseError (run_program handles it), and
  /// BadInput where an input does not exist.
  void parse(int argc, char** argv);

  bool json() const { return json_; }
  bool quiet() const { return quiet_; }
  int threads() const { return threads_; }
  int seed() const { return seed_; }

  /// Returns a progress bar, which shows nothing with --quiet.
  ProgressFunction progress(const std::string& label) const;

  /// Prints a line on stderr, unless --quiet.
  void say(const std::string& line) const;

  /// Records warnings (whole sentences without a full stop) for the result, each once, and prints them on stderr, even
  /// with --quiet; those among `said` were printed by an earlier stage and are not repeated.
  void warn(const std::vector<std::string>& warnings, const std::vector<std::string>& said = {});

  /// Returns the result: stage, version, settings, inputs' hashes, seconds, cpu_seconds, peak_memory_bytes, warnings,
  /// then `metrics` at the same level. `seconds` is the stage's own work, without reading and writing files.
  Json result(double seconds, const Json& metrics) const;

  /// Writes `result`, and under "outputs" the hash of each of `outputs`, to `<stage>.json`; commits them all, and
  /// prints `result` on stdout if --json was given.
  void finish(OutputSet& outputs, const Json& result) const;

  /// Finishes without `<stage>.json`, for tools whose output is a single file.
  void finish_without_record(OutputSet& outputs, const Json& result) const;

  /// Finishes without outputs: prints `result` on stdout if --json was given.
  void finish_without_output(const Json& result) const;

 private:
  /// Returns the command line's words. Values that look like options, such as "-z", are joined to the option before
  /// that takes them.
  std::vector<std::string> joined_values(int argc, char** argv) const;

  std::string program_;
  std::string stage_;
  std::unique_ptr<CLI::App> app_;
  bool json_ = false;
  bool quiet_ = false;
  int threads_ = 0;
  int seed_ = 1;
  std::vector<const std::filesystem::path*> inputs_;
  std::vector<const std::vector<std::filesystem::path>*> input_lists_;
  std::vector<std::filesystem::path> also_read_;
  std::vector<std::string> warnings_;
  std::vector<OptionSet> option_sets_;
  std::optional<ThreadLimit> thread_limit_;
};

/// Runs the body of a main(): maps exceptions to exit statuses and one message on stderr each, and ends by the signal
/// where one interrupted it. `program` starts the message.
int run_program(const std::string& program, const std::function<void()>& body);

}  // namespace kiln
