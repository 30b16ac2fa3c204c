// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>
#include <string>

namespace kiln {

/// Exit statuses of every executable, the same in all of them.
enum class ExitCode : int {
  done = 0,
  failed = 1,         ///< failed inside: a defect of Kiln, or memory or the disk ran out
  wrong_usage = 2,    ///< an option that does not exist or whose value is out of range
  bad_input = 3,      ///< a file that cannot be read, understood or written
  budget_missed = 4,  ///< everything ran, a quality budget was not met
  machine_lacks = 5,  ///< the machine lacks something, such as a GL driver
};

/// A file (or folder) does not hold what the stage needs.
class BadInput : public std::runtime_error {
 public:
  /// The message reads "FILE: FOUND; expected EXPECTED; REMEDY".
  BadInput(const std::string& file, const std::string& found, const std::string& expected, const std::string& remedy)
      : std::runtime_error(file + ": " + found + "; expected " + expected + "; " + remedy),
        file_(file),
        found_(found),
        expected_(expected),
        remedy_(remedy) {}

  /// Returns the parts of the message.
  const std::string& file() const { return file_; }
  const std::string& found() const { return found_; }
  const std::string& expected() const { return expected_; }
  const std::string& remedy() const { return remedy_; }

 private:
  std::string file_, found_, expected_, remedy_;
};

/// The command line asks for something that does not exist.
class WrongUsage : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A quality budget was missed; the outputs are written all the same.
class BudgetMissed : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The disk is full.
class DiskFull : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The machine has no such device, driver or limit.
class MachineLacks : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The process was asked to stop: Ctrl-C, or SIGTERM.
class Interrupted : public std::runtime_error {
 public:
  Interrupted() : std::runtime_error("interrupted") {}
};

}  // namespace kiln
