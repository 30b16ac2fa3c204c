// SPDX-License-Identifier: GPL-3.0-or-later
#include <CLI/CLI.hpp>
#include <csignal>
#include <cstdio>

#include "base/command_line.h"
#include "base/errors.h"
#include "base/help_pages.h"
#include "base/interruption.h"
#include "kiln/commands.h"

namespace {

constexpr const char* purpose =
    "Runs a content pipeline: every stage of every asset, through make, where something changed.\n"
    "Exit status: 0 done, 1 failed inside, 2 wrong usage, 3 bad input, 4 a quality budget was missed,\n"
    "5 the machine lacks something; where several stages fail, the first of 1, 5, 3, 2, 4 that occurred.";

}  // namespace

int main(int argc, char** argv) {
  using namespace kiln;
  int status = 0;
  const int thrown = run_program("kiln", [&] {
    CLI::App app(purpose, "kiln");
    app.set_version_flag("--version", std::string(KILN_VERSION));
    app.require_subcommand(1);
    add_help_forms(app);
    Commands commands(app);
    try {
      app.parse(argc, argv);
      status = commands.status();
    } catch (const CLI::Success& asked_for_help) {
      app.exit(asked_for_help);
      throw;
    } catch (const Interrupted&) {
      std::fprintf(stderr,
                   "kiln: interrupted; stages that were done are kept, and a bake that had begun goes on from there\n");
      std::signal(noted_signal(), SIG_DFL);
      std::raise(noted_signal());
    }
  });
  return thrown != 0 ? thrown : status;
}
