// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/make_process.h"

#include <cstdlib>
#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include "base/errors.h"

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// A folder that is removed at the end of the scope.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern = (fs::temp_directory_path() / "kiln-XXXXXX").string();
    if (mkdtemp(pattern.data()) == nullptr)
      throw BadInput(pattern, "cannot be made", "a folder for temporary files",
                     "set TMPDIR to one that can be written");
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// A duplicate of our stderr that make's children write to, while make's own messages go to us.
class MessageDescriptor {
 public:
  MessageDescriptor() : descriptor_(fcntl(STDERR_FILENO, F_DUPFD, 100)) {}
  ~MessageDescriptor() {
    if (descriptor_ >= 0) close(descriptor_);
  }
  MessageDescriptor(const MessageDescriptor&) = delete;
  MessageDescriptor& operator=(const MessageDescriptor&) = delete;

  std::string number() const { return descriptor_ < 0 ? "" : std::to_string(descriptor_); }

 private:
  int descriptor_;
};

}  // namespace

MakeEnd run_make(const MakeSettings& make) {
  const TemporaryFolder temporary;
  const fs::path events_file = temporary.path() / "events";
  const MessageDescriptor messages;
  MakeEnd result;
  ProcessSettings settings;
  settings.folder = make.folder;
  settings.environment = {{step_environment::events, events_file.string()},
                          {step_environment::messages, messages.number()},
                          {step_environment::alone, make.alone ? "1" : ""}};
  // Removes variables of an outer make: one that runs the driver must not lend its flags and job slots to ours.
  for (const char* name : {"MAKEFLAGS", "MFLAGS", "MAKELEVEL", "GNUMAKEFLAGS", "MAKEFILES"})
    settings.environment.emplace_back(name, "");
  settings.on_output_line = [](const std::string&) {};
  settings.on_error_line = [&](const std::string& line) { result.errors.push_back(line); };
  std::vector<std::string> command = {"make", "--silent", "--no-print-directory", "-f", make.makefile.string()};
  command.push_back(fmt::format("-j{}", make.jobs));
  command.push_back(fmt::format("THREADS={}", make.threads));
  if (make.keep_going) command.emplace_back("--keep-going");
  command.insert(command.end(), make.targets.begin(), make.targets.end());
  result.end = run_process(command, settings);
  result.events = read_events(events_file);
  return result;
}

void fail_as_make(const MakeEnd& make) {
  std::string text;
  for (const std::string& line : make.errors) text += (text.empty() ? "" : "\n") + line;
  throw std::runtime_error(text.empty() ? "make ended without a word" : text);
}

}  // namespace kiln
