// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/makefile.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace kiln {

namespace fs = std::filesystem;

namespace {

bool is_plain(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || std::string_view("_-+./,:@").find(c) != std::string::npos;
}

/// Quotes a word of a recipe: for the shell, and its dollars for make.
std::string recipe_word(const std::string& word) {
  std::string text;
  for (const char c : shell_quoted(word)) text += c == '$' ? "$$" : std::string(1, c);
  return text;
}

/// Escapes the value of a variable, in which # would begin a comment.
std::string variable_value(const std::string& word) {
  std::string text;
  for (const char c : recipe_word(word)) text += c == '#' ? "\\#" : std::string(1, c);
  return text;
}

/// Tests whether a name can be an additional target of make.
bool is_target(const std::string& name) {
  return name != "all" && std::isalpha(static_cast<unsigned char>(name[0])) != 0 &&
         std::all_of(name.begin(), name.end(),
                     [](unsigned char c) { return c < 0x80 && (std::isalnum(c) != 0 || c == '-' || c == '_'); });
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  if (!word.empty() && std::all_of(word.begin(), word.end(), is_plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string shown_command(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += ' ';
    for (const char c : shell_quoted(word))
      text += static_cast<unsigned char>(c) < 0x20 || c == 0x7f ? fmt::format("\\{:03o}", c) : std::string(1, c);
  }
  return text;
}

std::vector<std::vector<std::size_t>> needs_of(const std::vector<MakeRule>& rules) {
  std::map<fs::path, std::size_t> maker;
  for (std::size_t k = 0; k < rules.size(); ++k)
    for (const fs::path& output : rules[k].run.outputs) maker[output] = k;
  std::vector<std::vector<std::size_t>> needs(rules.size());
  for (std::size_t k = 0; k < rules.size(); ++k) {
    std::set<std::size_t> makers;
    for (const fs::path& input : rules[k].run.inputs)
      if (const auto found = maker.find(input); found != maker.end() && found->second != k)
        makers.insert(found->second);
    needs[k].assign(makers.begin(), makers.end());
  }
  return needs;
}

std::vector<std::string> targets_of(const std::vector<MakeRule>& rules) {
  std::vector<std::string> targets;
  std::size_t number = 0;
  for (std::size_t k = 0; k < rules.size(); ++k) {
    number += k == 0 || rules[k - 1].asset != rules[k].asset ? 1u : 0u;
    targets.push_back(fmt::format("{}.{}", number, rules[k].run.name));
  }
  return targets;
}

std::string makefile_text(const std::vector<MakeRule>& rules, const fs::path& programs) {
  std::string text =
      "# Written by `kiln build`, which runs it from the folder of the pipeline file. Changes here are overwritten.\n"
      "#\n"
      "# Times decide nothing: every step is asked, and sees by the content of what it reads and made whether it must "
      "run.\n"
      "\n"
      "SHELL := /bin/sh\n"
      "MAKEFLAGS += --no-builtin-rules\n";
  text += fmt::format("PROGRAMS := {}\n", variable_value(programs.string()));
  text +=
      "# Threads of each stage, 0 for all cores; no result depends on them.\n"
      "THREADS := 0\n"
      "STEP = $(PROGRAMS)/kiln step --threads $(THREADS)\n"
      ".SUFFIXES:\n";

  const std::vector<std::vector<std::size_t>> needs = needs_of(rules);
  const std::vector<std::string> targets = targets_of(rules);
  std::string phony, all, body;
  for (std::size_t k = 0; k < rules.size(); ++k) {
    const MakeRule& rule = rules[k];
    const bool is_first = k == 0 || rules[k - 1].asset != rule.asset;
    const bool is_last = k + 1 == rules.size() || rules[k + 1].asset != rule.asset;
    if (is_first) body += fmt::format("\n# {}\n", rule.asset);
    body += fmt::format("# {}\n{}:", shown_command(rule.run.whole_command()), targets[k]);
    for (const std::size_t need : needs[k]) body += " " + targets[need];
    body += fmt::format("\n\t@$(STEP) {}\n", recipe_word(rule.plan.string()));
    phony += " " + targets[k];
    if (!is_last) continue;
    all += " " + targets[k];
    if (!is_target(rule.asset)) continue;
    body += fmt::format("{}: {}\n", rule.asset, targets[k]);
    phony += " " + rule.asset;
  }
  return text + "\n.PHONY: all" + phony + "\nall:" + all + "\n" + body;
}

}  // namespace kiln
