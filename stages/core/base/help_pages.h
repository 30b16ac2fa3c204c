// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace CLI {  // NOLINT(readability-identifier-naming)
class App;
}

namespace kiln {

/// Forms of a program's help besides --help, all made of its option table.
enum class HelpForm {
  man,   ///< a page for man(1), section 1
  bash,  ///< a completion for bash
  zsh,   ///< a completion for zsh
};

/// Adds --help-as, which is not shown by --help: prints the help in that form and ends the program as --help does.
void add_help_forms(CLI::App& app);

/// The help of a program, its subcommands included, in that form.
std::string help_text(const CLI::App& app, HelpForm form);

}  // namespace kiln
