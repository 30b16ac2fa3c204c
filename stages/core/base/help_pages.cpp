// SPDX-License-Identifier: MIT
#include "base/help_pages.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <iterator>
#include <regex>
#include <vector>

namespace kiln {

namespace {

using Options = std::vector<const CLI::Option*>;

/// Options that --help shows, in its order.
Options shown_options(const CLI::App& app) {
  Options shown;
  for (const CLI::Option* option : app.get_options())
    if (!option->get_group().empty()) shown.push_back(option);
  return shown;
}

std::vector<const CLI::App*> shown_subcommands(const CLI::App& app) {
  std::vector<const CLI::App*> shown;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; }))
    if (!command->get_group().empty()) shown.push_back(command);
  return shown;
}

bool takes_value(const CLI::Option& option) { return option.get_items_expected_max() > 0; }

/// "-o" and "--output" of an option; none of a positional input.
std::vector<std::string> names_of(const CLI::Option& option) {
  std::vector<std::string> names;
  for (const std::string& name : option.get_snames()) names.push_back("-" + name);
  for (const std::string& name : option.get_lnames()) names.push_back("--" + name);
  return names;
}

/// Finds the words that an option takes, if its help ends in a list of them: "(default auto; auto, egl or beams)" or
/// "The last stage: simplify, atlas, normals".
std::vector<std::string> words_of(const CLI::Option& option) {
  const std::string& help = option.get_description();
  std::smatch found;
  static const std::regex list(
      R"((?:; ([a-z0-9-]+(?:, [a-z0-9-]+)* or [a-z0-9-]+)\)|: ([a-z0-9-]+(?:, [a-z0-9-]+){2,}))$)");
  if (!std::regex_search(help, found, list)) return {};
  const std::string text = found[1].matched ? found[1] : found[2];
  static const std::regex separator(", | or ");
  return {std::sregex_token_iterator(text.begin(), text.end(), separator, -1), std::sregex_token_iterator()};
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

/// Escapes text for roff.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  safe = replaced(safe, "\n", "\n.br\n");
  return !safe.empty() && (safe[0] == '.' || safe[0] == '\'') ? "\\&" + safe : safe;
}

/// Options that --help shows, those of one group together.
Options grouped_options(const CLI::App& app) {
  std::vector<std::string> groups;
  const Options options = shown_options(app);
  for (const CLI::Option* option : options)
    if (std::find(groups.begin(), groups.end(), option->get_group()) == groups.end())
      groups.push_back(option->get_group());
  Options grouped;
  for (const std::string& group : groups)
    std::copy_if(options.begin(), options.end(), std::back_inserter(grouped),
                 [&](const CLI::Option* option) { return option->get_group() == group; });
  return grouped;
}

void add_man_options(const CLI::App& app, std::string& page) {
  std::string group;
  for (const CLI::Option* option : grouped_options(app)) {
    if (option->get_group() != group) page += ".SS " + roff(group = option->get_group()) + "\n";
    const std::string names = fmt::format("{}", fmt::join(names_of(*option), ", "));
    const std::string value = takes_value(*option) && !option->get_positional() ? " \\fIVALUE\\fR" : "";
    page += ".TP\n\\fB" + roff(names.empty() ? option->get_name(true) : names) + "\\fR" + value + "\n" +
            roff(option->get_description()) + "\n";
  }
}

std::string man_page(const CLI::App& app) {
  const std::string& name = app.get_name();
  std::string inputs;
  for (const CLI::Option* option : shown_options(app))
    if (option->get_positional())
      inputs += " \\fI" + roff(option->get_name(true)) + "\\fR" + (option->get_items_expected_max() > 1 ? " ..." : "");
  const std::string purpose = app.get_description();
  std::string page =
      fmt::format(".TH {} 1 \"\" \"Kiln {}\" \"Kiln\"\n.ad l\n.SH NAME\n{} \\- {}\n.SH SYNOPSIS\n\\fB{}\\fR", name,
                  KILN_VERSION, roff(name), roff(purpose.substr(0, purpose.find('\n'))), roff(name));
  page += (shown_subcommands(app).empty() ? "" : " \\fICOMMAND\\fR") + inputs + " [\\fIOPTIONS\\fR]\n";
  page += ".SH DESCRIPTION\n" + roff(purpose) + "\n.SH OPTIONS\n";
  add_man_options(app, page);
  for (const CLI::App* command : shown_subcommands(app)) {
    page += ".SH COMMAND " + roff(command->get_name()) + "\n" + roff(command->get_description()) + "\n";
    add_man_options(*command, page);
  }
  page +=
      ".SH EXIT STATUS\n0 done, 1 failed inside, 2 wrong usage, 3 bad input, 4 a quality budget was missed, 5 the "
      "machine lacks something\n";
  return page;
}

/// Writes branches of a shell's `case` over the previous word: the words that options take.
std::string value_cases(const CLI::App& app) {
  std::string cases;
  for (const CLI::Option* option : shown_options(app))
    if (const std::vector<std::string> words = words_of(*option); !words.empty())
      cases += fmt::format("    {}) COMPREPLY=($(compgen -W \"{}\" -- \"$word\")); return ;;\n",
                           fmt::join(names_of(*option), "|"), fmt::join(words, " "));
  return cases;
}

std::string all_names(const CLI::App& app) {
  std::vector<std::string> all;
  for (const CLI::Option* option : shown_options(app))
    for (const std::string& name : names_of(*option)) all.push_back(name);
  return fmt::format("{}", fmt::join(all, " "));
}

std::string bash_completion(const CLI::App& app) {
  const std::string function = "_" + replaced(app.get_name(), "-", "_");
  std::string cases = value_cases(app), commands, command_names;
  for (const CLI::App* command : shown_subcommands(app)) {
    cases += value_cases(*command);
    command_names += " " + command->get_name();
    commands += fmt::format("    {}) names=\"{}\" ;;\n", command->get_name(), all_names(*command));
  }
  std::string text = function + "() {\n  local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]}\n";
  text += "  local names=\"" + all_names(app) + "\"\n";
  // Bash splits --option=word at the equals sign.
  text += "  if [[ $word == = ]]; then word=; elif [[ $before == = ]]; then before=${COMP_WORDS[COMP_CWORD-2]}; fi\n";
  text += "  case $before in\n" + cases + "  esac\n";
  if (!commands.empty()) {
    text += "  case ${COMP_WORDS[1]} in\n" + commands + "  esac\n";
    text += "  if [[ $COMP_CWORD == 1 ]]; then COMPREPLY=($(compgen -W \"$names" + command_names +
            "\" -- \"$word\")); return; fi\n";
  }
  text +=
      "  if [[ $word == -* ]]; then COMPREPLY=($(compgen -W \"$names\" -- \"$word\"));\n"
      "  else COMPREPLY=($(compgen -f -- \"$word\")); fi\n}\n";
  return text + "complete -o filenames -F " + function + " " + app.get_name() + "\n";
}

/// Writes options as arguments of zsh's _arguments.
std::string zsh_options(const CLI::App& app) {
  std::string text;
  for (const CLI::Option* option : shown_options(app)) {
    std::string help = option->get_description();
    for (const char* special : {"\\", "'", "[", "]", ":"})
      help = replaced(help, special, special[0] == '\'' ? "'\\''" : std::string("\\") + special);
    help = replaced(help, "\n", " ");
    const std::vector<std::string> words = words_of(*option);
    const std::string value = !takes_value(*option) ? ""
                              : words.empty()       ? ":value:_files"
                                                    : fmt::format(":value:({})", fmt::join(words, " "));
    for (const std::string& name : names_of(*option)) text += fmt::format("    '{}[{}]{}' \\\n", name, help, value);
  }
  return text;
}

std::string zsh_completion(const CLI::App& app) {
  std::string text = "#compdef " + app.get_name() + "\n";
  const auto commands = shown_subcommands(app);
  if (commands.empty()) return text + "_arguments \\\n" + zsh_options(app) + "    '*:file:_files'\n";
  text += "if (( CURRENT == 2 )); then\n  _values command";
  for (const CLI::App* command : commands)
    text += fmt::format(" '{}[{}]'", command->get_name(), replaced(command->get_description(), "'", ""));
  text += "\n  return\nfi\ncase ${words[2]} in\n";
  for (const CLI::App* command : commands)
    text += fmt::format("  {}) _arguments \\\n{}    '*:file:_files' ;;\n", command->get_name(), zsh_options(*command));
  return text + "esac\n";
}

}  // namespace

std::string help_text(const CLI::App& app, HelpForm form) {
  if (form == HelpForm::man) return man_page(app);
  return form == HelpForm::bash ? bash_completion(app) : zsh_completion(app);
}

void add_help_forms(CLI::App& app) {
  app.add_option_function<std::string>(
         "--help-as",
         [&app](const std::string& word) {
           const HelpForm form = word == "man" ? HelpForm::man : word == "bash" ? HelpForm::bash : HelpForm::zsh;
           std::fputs(help_text(app, form).c_str(), stdout);
           throw CLI::Success();
         })
      ->check(CLI::IsMember({"man", "bash", "zsh"}))
      ->trigger_on_parse()
      ->group("");
}

}  // namespace kiln
