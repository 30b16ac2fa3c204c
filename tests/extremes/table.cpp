// SPDX-License-Identifier: GPL-3.0-or-later
#include "table.h"

#include <algorithm>
#include <ctime>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <thread>

namespace kiln::extremes {

namespace {

const char* name_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::holds:
      return "holds";
    case Verdict::refused:
      return "refused";
    case Verdict::stated:
      return "";
    case Verdict::misses:
      break;
  }
  return "**misses**";
}

/// Keeps text within a cell of a table.
std::string cell(const std::string& text) {
  std::string plain;
  for (const char c : text) {
    if (c == '|') plain += '\\';
    plain += c == '\n' ? ' ' : c;
  }
  return plain;
}

/// Breaks a paragraph into lines of at most 120 columns.
std::string wrapped(const std::string& paragraph) {
  constexpr std::size_t columns = 120;
  std::istringstream words(paragraph);
  std::string text, line;
  for (std::string word; words >> word;) {
    if (!line.empty() && line.size() + 1 + word.size() > columns) {
      text += line + "\n";
      line.clear();
    }
    line += (line.empty() ? "" : " ") + word;
  }
  return text + line;
}

std::string processor() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) return line.substr(line.find(':') + 2);
  return "an unknown processor";
}

std::string today() {
  const std::time_t now = std::time(nullptr);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%d", std::gmtime(&now));
  return text;
}

}  // namespace

Row Row::at_most(std::string what, std::string extreme, const std::string& quantity, double value, double bound) {
  return {std::move(what), std::move(extreme), quantity + " " + number(value), number(bound),
          value <= bound ? Verdict::holds : Verdict::misses};
}

bool Table::is_missed() const {
  return std::any_of(rows.begin(), rows.end(), [](const Row& row) { return row.verdict == Verdict::misses; });
}

std::string number(double value) { return fmt::format("{:.3g}", value); }

std::string grouped(long long value) {
  std::string digits = std::to_string(value);
  for (auto place = static_cast<long long>(digits.size()) - 3; place > 0; place -= 3)
    digits.insert(static_cast<std::size_t>(place), ",");
  return digits;
}

std::string to_markdown(const Table& table) {
  std::string text = fmt::format("## {}\n\n{}\n\n", table.title, wrapped(table.finding));
  text += "| what | extreme | measured | bound | verdict |\n| --- | --- | --- | --- | --- |\n";
  for (const Row& row : table.rows)
    text += fmt::format("| {} | {} | {} | {} | {} |\n", cell(row.what), cell(row.extreme), cell(row.measured),
                        cell(row.bound), name_of(row.verdict));
  if (!table.notes.empty()) text += "\n" + wrapped(table.notes) + "\n";
  return text;
}

std::string to_page(const std::vector<Table>& tables) {
  std::size_t rows = 0, missed = 0;
  for (const Table& table : tables) {
    rows += table.rows.size();
    for (const Row& row : table.rows) missed += row.verdict == Verdict::misses;
  }
  std::string text = "# The extremes, measured\n\n";
  text += wrapped(fmt::format(
              "What Kiln does where numbers are far out: of {} measurements {} miss their bound. `make extremes` makes "
              "this page anew (`tests/extremes`); `make test` runs the quick part of it and fails where a bound is "
              "missed.",
              rows, missed == 0 ? "none" : std::to_string(missed))) +
          "\n\n";
  text += fmt::format(
      "- A row **holds** where the measurement is within its bound, and is **refused** where a program says what is "
      "wrong\n  with its input (exit status 3) or its options (2), and leaves no output behind.\n"
      "- Transfer is compared by relative L2 over the covered texels. An unoccluded texel has t_0 = 0.282095.\n"
      "- Machine: {}, {} threads, {}. Times are of a machine that others used, too: read\n  their growth, not their "
      "size.\n",
      processor(), std::thread::hardware_concurrency(), today());
  for (const Table& table : tables) text += "\n" + to_markdown(table);
  return text;
}

}  // namespace kiln::extremes
