// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <CLI/CLI.hpp>

namespace kiln {

/// Adds kiln's subcommands to `app`: build, report, sweep, list, clean, init and check, and those that the Makefile
/// calls. `status` becomes the exit status. Must outlive the parsing of `app`.
class Commands {
 public:
  explicit Commands(CLI::App& app);
  ~Commands();
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  int status() const;

 private:
  struct Values;
  std::unique_ptr<Values> values_;
};

}  // namespace kiln
