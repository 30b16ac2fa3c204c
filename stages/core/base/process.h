#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

namespace kiln {

struct ProcessSettings {
  std::filesystem::path folder;                                  ///< to run in; empty: where this process runs
  std::vector<std::pair<std::string, std::string>> environment;  ///< to set; an empty value removes the variable
  std::function<void(const std::string& line)> on_output_line;   ///< gets stdout; empty: the child shares ours
  std::function<void(const std::string& line)> on_error_line;    ///< gets stderr; empty: the child shares ours
};

/// How a process ended: by an exit status, or by a signal.
struct ProcessEnd {
  int exit_status = 0;
  int signal = 0;  ///< 0: it exited by itself

  bool succeeded() const { return exit_status == 0 && signal == 0; }
};

/// Runs a program without a shell (arguments[0] is a path, or a name looked up in PATH) and waits for its end. Asked to
/// stop (see stop_on_signals), it passes that on and still waits, so that nothing is left running. Throws MachineLacks
/// where the program cannot be started.
ProcessEnd run_process(const std::vector<std::string>& arguments, const ProcessSettings& settings = {});

/// The folder that this process' executable lies in, where its siblings are.
std::filesystem::path program_folder();

}  // namespace kiln
