// SPDX-License-Identifier: GPL-3.0-or-later
// Measures Kiln at its extremes: extremes [--quick] [--only SUBJECT] [-o PAGE.md]. Exit status 1 where a bound is
// missed.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <fstream>

#include "base/errors.h"
#include "subjects.h"

int main(int argc, char** argv) {
  using namespace kiln::extremes;
  struct Subject {
    const char* name;
    Table (*measure)(const Bench& bench);
    bool is_long;  ///< left out of --quick
  };
  constexpr Subject subjects[] = {{"scale", measure_scale, false},           {"shapes", measure_hard_shapes, false},
                                  {"directions", measure_directions, false}, {"ranges", measure_ranges, false},
                                  {"atlases", measure_atlases, false},       {"lights", measure_lights, false},
                                  {"growth", measure_growth, true}};
  CLI::App app("Measures Kiln at its extremes.");
  Bench bench;
  std::string only, page;
  app.add_flag("--quick", bench.quick, "The extremes alone, in seconds");
  app.add_option("--only", only, "One subject: scale, shapes, directions, ranges, atlases, lights or growth");
  app.add_option("-o,--output", page, "The page, Markdown; else the tables go to stdout");
  CLI11_PARSE(app, argc, argv);

  std::vector<Table> tables;
  bool is_missed = false;
  for (const Subject& subject : subjects) {
    if (only.empty() ? bench.quick && subject.is_long : only != subject.name) continue;
    std::fprintf(stderr, "%s ...\n", subject.name);
    try {
      tables.push_back(subject.measure(bench));
    } catch (const std::exception& error) {
      tables.push_back({subject.name, error.what(), {{subject.name, "", error.what(), "", Verdict::misses}}, ""});
    }
    is_missed = is_missed || tables.back().is_missed();
    if (page.empty()) std::printf("%s\n", to_markdown(tables.back()).c_str());
  }
  if (tables.empty()) return std::fprintf(stderr, "extremes: no subject '%s'\n", only.c_str()), 2;
  if (!page.empty()) std::ofstream(page) << to_page(tables);
  return is_missed ? 1 : 0;
}
