// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace kiln {

struct ProcessSettings {
  std::filesystem::path folder;                                  ///< folder to run in; empty: that of this process
  std::vector<std::pair<std::string, std::string>> environment;  ///< variables to set; an empty value removes one
  std::function<void(const std::string& line)> on_output_line;   ///< receives stdout; empty: the child shares ours
  std::function<void(const std::string& line)> on_error_line;    ///< receives stderr; empty: the child shares ours
};

/// End of a process: an exit status, or a signal.
struct ProcessEnd {
  int exit_status = 0;
  int signal = 0;  ///< 0: it exited by itself

  bool succeeded() const { return exit_status == 0 && signal == 0; }
};

/// Runs a program without a shell (arguments[0] is a path, or a name looked up in PATH) and waits for its end. If this
/// process is asked to stop (see stop_on_signals), passes that on and still waits, so that nothing is left running.
/// Throws MachineLacks where the program cannot be started.
ProcessEnd run_process(const std::vector<std::string>& arguments, const ProcessSettings& settings = {});

/// Returns the CPU time, in seconds, of this process and of children that it has waited for.
double cpu_seconds();

/// Returns the folder of this process's executable, which also holds the other programs.
std::filesystem::path program_folder();

}  // namespace kiln
