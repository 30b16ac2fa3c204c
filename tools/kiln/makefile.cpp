#include "kiln/makefile.h"

#include <algorithm>
#include <fmt/format.h>
#include <set>

namespace kiln {

namespace fs = std::filesystem;

namespace {

/// A word of a recipe: for the shell, its dollars for make.
std::string recipe_word(const std::string& word) {
  std::string text;
  for (const char c : shell_quoted(word)) text += c == '$' ? "$$" : std::string(1, c);
  return text;
}

std::string joined(const std::vector<fs::path>& paths) {
  std::string text;
  std::set<fs::path> seen;
  for (const fs::path& path : paths)
    if (seen.insert(path).second) text += (text.empty() ? "" : " ") + make_quoted(path);
  return text;
}

/// What expands to a phony prerequisite where one of the files is missing.
std::string forced_where_missing(const std::vector<fs::path>& files) {
  std::string text = "$(shell for file in";
  for (const fs::path& file : files) {
    text += ' ';
    for (const char c : recipe_word(file.string())) text += c == '#' ? "\\#" : std::string(1, c);
  }
  return text + "; do [ -e \"$$file\" ] || echo missing; done)";
}

std::string recipe(const MakeRule& rule) {
  std::string text =
      fmt::format("\t@$(STEP) {} {} -- $(PROGRAMS)/{}", rule.asset, rule.run.name, recipe_word(rule.run.command[0]));
  for (std::size_t i = 1; i < rule.run.command.size(); ++i) text += " " + recipe_word(rule.run.command[i]);
  return text + "\n";
}

}  // namespace

std::string shell_quoted(const std::string& word) {
  const auto plain = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-+./,:@").find(c) != std::string_view::npos;
  };
  if (!word.empty() && std::all_of(word.begin(), word.end(), plain)) return word;
  std::string text = "'";
  for (const char c : word) text += c == '\'' ? "'\\''" : std::string(1, c);
  return text + "'";
}

std::string make_quoted(const fs::path& path) {
  std::string text;
  for (const char c : path.string()) {
    if (c == ' ' || c == '#') text += '\\';
    if (c == '$') text += '$';
    text += c;
  }
  return text;
}

std::string makefile_text(const std::vector<MakeRule>& rules, const fs::path& programs) {
  std::string text =
      "# Written by `kiln build`, which runs it from the folder of the pipeline file. Changes here are overwritten.\n"
      "\n"
      "SHELL := /bin/sh\n"
      "MAKEFLAGS += --no-builtin-rules\n";
  text += fmt::format("PROGRAMS := {}\n", recipe_word(programs.string()));
  text +=
      "# Threads of each stage, 0 for all cores; no result depends on them.\n"
      "THREADS := 0\n"
      "STEP = $(PROGRAMS)/kiln step --threads $(THREADS)\n"
      ".SUFFIXES:\n";

  std::vector<std::string> assets;
  for (const MakeRule& rule : rules)
    if (assets.empty() || assets.back() != rule.asset) assets.push_back(rule.asset);
  text += "\n.PHONY: all missing";
  for (const std::string& asset : assets) text += " " + asset;
  text += "\nall:";
  for (const std::string& asset : assets) text += " " + asset;
  text += "\n";

  // No .DELETE_ON_ERROR: a stage renames its outputs when all of them are whole, so a failed run leaves the earlier
  // ones, which are older than what made it run and so are made again.
  //
  // The record, renamed last, stands for all outputs of a stage. Not a group of targets ("&:"): make would find the
  // record up to date, then remake it for another missing output, and yet not remake what depends on it.
  for (const std::string& asset : assets) {
    std::string records;
    std::string body;
    for (const MakeRule& rule : rules) {
      if (rule.asset != asset) continue;
      const fs::path& record = rule.run.outputs.front();
      const std::vector<fs::path> others(rule.run.outputs.begin() + 1, rule.run.outputs.end());
      std::vector<fs::path> needed = rule.run.inputs;
      needed.push_back(rule.stamp);
      records += " " + make_quoted(record);
      body += fmt::format("\n{}: {}{}\n{}", make_quoted(record), joined(needed),
                          others.empty() ? "" : " \\\n    " + forced_where_missing(others), recipe(rule));
      if (!others.empty()) body += fmt::format("{}: {} ;\n", joined(others), make_quoted(record));
    }
    text += fmt::format("\n# {}\n{}:{}\n{}", asset, asset, records, body);
  }
  return text;
}

}  // namespace kiln
