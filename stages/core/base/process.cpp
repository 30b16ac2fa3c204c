// SPDX-License-Identifier: MIT
#include "base/process.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <map>
#include <poll.h>
#include <spawn.h>
#include <string_view>
#include <sys/resource.h>
#include <sys/wait.h>
#include <system_error>
#include <unistd.h>

#include "base/errors.h"
#include "base/interruption.h"

namespace kiln {

namespace {

// Interval at which a waiting parent checks whether it was asked to stop.
constexpr int poll_milliseconds = 10;

/// Reading end of one of the child's streams, split into lines.
class LineReader {
 public:
  LineReader(int stream, const std::function<void(const std::string&)>& on_line, posix_spawn_file_actions_t& actions)
      : on_line_(on_line) {
    if (!on_line_) return;
    if (pipe2(ends_.data(), O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe2");
    posix_spawn_file_actions_adddup2(&actions, ends_[1], stream);
  }
  ~LineReader() {
    for (const int end : ends_)
      if (end >= 0) close(end);
  }
  LineReader(const LineReader&) = delete;
  LineReader& operator=(const LineReader&) = delete;

  /// Starts reading, once the child has its own copy of the writing end.
  void start() {
    if (ends_[1] >= 0) close(ends_[1]);
    ends_[1] = -1;
  }

  bool open() const { return ends_[0] >= 0; }
  int file() const { return ends_[0]; }

  void read_some() {
    std::array<char, 4096> bytes;
    const ssize_t count = read(ends_[0], bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) return;
    if (count > 0) {
      pending_.append(bytes.data(), static_cast<std::size_t>(count));
      for (std::size_t end; (end = pending_.find('\n')) != std::string::npos; pending_.erase(0, end + 1))
        on_line_(pending_.substr(0, end));
      return;
    }
    if (!pending_.empty()) on_line_(pending_);
    close(ends_[0]);
    ends_[0] = -1;
  }

 private:
  const std::function<void(const std::string&)>& on_line_;
  std::array<int, 2> ends_ = {-1, -1};
  std::string pending_;
};

std::vector<std::string> changed_environment(const std::vector<std::pair<std::string, std::string>>& changes) {
  std::map<std::string, std::string> variables;
  for (char** entry = environ; *entry != nullptr; ++entry) {
    const std::string_view text = *entry;
    const std::size_t equals = text.find('=');
    if (equals != std::string_view::npos) variables[std::string(text.substr(0, equals))] = text.substr(equals + 1);
  }
  for (const auto& [name, value] : changes)
    if (value.empty())
      variables.erase(name);
    else
      variables[name] = value;
  std::vector<std::string> entries;
  for (const auto& [name, value] : variables) entries.push_back(name + "=" + value);
  return entries;
}

std::vector<char*> pointers(std::vector<std::string>& texts) {
  std::vector<char*> result;
  for (std::string& text : texts) result.push_back(text.data());
  result.push_back(nullptr);
  return result;
}

/// Passes our own interruption on to the child, once.
void pass_on_signal(pid_t child, bool& passed_on) {
  if (passed_on || noted_signal() == 0) return;
  // Send SIGTERM, not SIGINT: a terminal has sent SIGINT to the child already, and make passes only SIGTERM on to its
  // children.
  kill(child, SIGTERM);
  passed_on = true;
}

}  // namespace

ProcessEnd run_process(const std::vector<std::string>& arguments, const ProcessSettings& settings) {
  std::vector<std::string> words = arguments;
  std::vector<std::string> variables = changed_environment(settings.environment);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  if (!settings.folder.empty()) posix_spawn_file_actions_addchdir_np(&actions, settings.folder.c_str());
  LineReader output(STDOUT_FILENO, settings.on_output_line, actions);
  LineReader errors(STDERR_FILENO, settings.on_error_line, actions);

  pid_t child = 0;
  const int failure = posix_spawnp(&child, words.front().c_str(), &actions, nullptr, pointers(words).data(),
                                   pointers(variables).data());
  posix_spawn_file_actions_destroy(&actions);
  if (failure != 0) throw MachineLacks(words.front() + ": cannot be started (" + std::strerror(failure) + ")");
  output.start();
  errors.start();

  bool passed_on = false;
  while (output.open() || errors.open()) {
    pass_on_signal(child, passed_on);
    std::array<pollfd, 2> files = {pollfd{output.file(), POLLIN, 0}, pollfd{errors.file(), POLLIN, 0}};
    if (poll(files.data(), files.size(), poll_milliseconds) <= 0) continue;
    if (files[0].revents != 0) output.read_some();
    if (files[1].revents != 0) errors.read_some();
  }
  int status = 0;
  for (pid_t ended = 0; ended != child;) {
    pass_on_signal(child, passed_on);
    ended = waitpid(child, &status, WNOHANG);
    if (ended < 0 && errno != EINTR) throw std::system_error(errno, std::generic_category(), "waitpid");
    if (ended == 0) poll(nullptr, 0, poll_milliseconds);
  }
  if (WIFSIGNALED(status)) return {128 + WTERMSIG(status), WTERMSIG(status)};
  return {WEXITSTATUS(status), 0};
}

double cpu_seconds() {
  double seconds = 0;
  for (const int whose : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    rusage usage = {};
    getrusage(whose, &usage);
    for (const timeval& time : {usage.ru_utime, usage.ru_stime})
      seconds += static_cast<double>(time.tv_sec) + 1e-6 * static_cast<double>(time.tv_usec);
  }
  return seconds;
}

std::filesystem::path program_folder() { return std::filesystem::read_symlink("/proc/self/exe").parent_path(); }

}  // namespace kiln
