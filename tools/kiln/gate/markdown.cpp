// SPDX-License-Identifier: GPL-3.0-or-later
#include "kiln/gate/markdown.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace kiln {

namespace {

/// Escapes what Markdown's tables give a meaning.
std::string cell(const std::string& text) {
  std::string result;
  for (const char c : text) {
    if (std::string_view("|\\`*_<>[]").find(c) != std::string_view::npos) result += '\\';
    result += c == '\n' ? ' ' : c;
  }
  return result;
}

/// Row of a table, and how much it matters among its like.
struct Row {
  std::string text;
  double weight = 0;
};

struct Table {
  std::string title;
  std::vector<Row> rows;
};

std::string was_text(const AssetGate& asset, const std::string& metric) {
  const std::optional<double> was = baseline_value(asset, metric);
  return was ? number_text(*was) : "";
}

std::string row(const std::string& asset, const std::string& what, const std::string& was, const std::string& now,
                const std::string& note) {
  return fmt::format("| {} | {} | {} | {} | {} |", cell(asset), cell(what), was, now, cell(note));
}

Row budget_row(const AssetGate& asset, const BudgetVerdict& verdict) {
  const Budget& budget = verdict.budget;
  const std::string limit = fmt::format("{} {}", budget.is_highest ? "at most" : "at least", number_text(budget.limit));
  const double excess =
      budget.limit == 0 ? std::abs(verdict.value) : std::abs(verdict.value - budget.limit) / std::abs(budget.limit);
  return {row(asset.name, budget.metric, was_text(asset, budget.metric), number_text(verdict.value), limit),
          std::isfinite(excess) ? excess : HUGE_VAL};
}

Row row_of_change(const AssetGate& asset, const MetricChange& change) {
  return {row(asset.name, change.metric, number_text(change.was), number_text(change.now),
              relative_text(change.relative())),
          std::abs(change.relative())};
}

Table failures_of(const Gate& gate) {
  Table table{"Fails", {}};
  for (const std::string& fault : gate.faults) table.rows.push_back({row("", fault, "", "", ""), HUGE_VAL});
  for (const AssetGate& asset : gate.assets) {
    for (const std::string& fault : {asset.fault, asset.picture_fault})
      if (!fault.empty()) table.rows.push_back({row(asset.name, fault, "", "", ""), HUGE_VAL});
    for (const BudgetVerdict& verdict : asset.budgets)
      if (!verdict.met) table.rows.push_back(budget_row(asset, verdict));
  }
  return table;
}

Table near_budgets(const Gate& gate) {
  Table table{"Near a budget", {}};
  for (const AssetGate& asset : gate.assets)
    for (const BudgetVerdict& verdict : asset.budgets)
      if (is_near(verdict)) table.rows.push_back(budget_row(asset, verdict));
  return table;
}

Table changes_of(const Gate& gate, ChangeKind kind, const std::string& title) {
  Table table{title, {}};
  for (const AssetGate& asset : gate.assets) {
    for (const MetricChange& change : asset.changes)
      if (change.kind == kind) table.rows.push_back(row_of_change(asset, change));
    if (kind == ChangeKind::worse && asset.picture && asset.picture->is_drift)
      table.rows.push_back({row(asset.name, "picture", "", fmt::format("{:+.2f} levels", asset.picture->mean_shift),
                                fmt::format("drift, not noise: sigma {:.2f}", asset.picture->sigma)),
                            std::abs(asset.picture->mean_shift)});
  }
  return table;
}

std::string headline(const Gate& gate) {
  std::size_t failing = gate.faults.empty() ? 0 : 1, worse = 0;
  for (const AssetGate& asset : gate.assets) {
    failing += asset.failures() > 0 ? 1u : 0u;
    worse += static_cast<std::size_t>(
        std::ranges::count(asset.changes, ChangeKind::worse, [](const MetricChange& change) { return change.kind; }));
  }
  const std::size_t count = gate.assets.size();
  std::string text = failing > 0 ? fmt::format("✗ {} of {} asset{} fail{}", failing, count, count == 1 ? "" : "s",
                                               failing == 1 ? "s" : "")
                                 : fmt::format("✓ {} asset{} within budget", count, count == 1 ? "" : "s");
  if (worse > 0) text += fmt::format(", {} metric{} got worse", worse, worse == 1 ? "" : "s");
  return "## Kiln: " + text;
}

/// Appends as many rows as `room` lines hold, the weightiest first; returns the lines used.
std::size_t append(const Table& table, std::size_t room, std::string& text) {
  constexpr std::size_t frame = 6;  // a blank line, the title, a blank line, two lines of header, "and more"
  if (table.rows.empty() || room <= frame) return 0;
  std::vector<Row> rows = table.rows;
  std::ranges::stable_sort(rows, std::greater<>(), &Row::weight);
  const std::size_t shown = std::min(rows.size(), room - frame);
  text += fmt::format("\n### {}\n\n| asset | metric | was | now | |\n| --- | --- | --- | --- | --- |\n", table.title);
  for (std::size_t k = 0; k < shown; ++k) text += rows[k].text + "\n";
  if (shown == rows.size()) return frame - 1 + shown;
  text += fmt::format("| | and {} more | | | |\n", rows.size() - shown);
  return frame + shown;
}

}  // namespace

std::string summary_markdown(const Gate& gate, bool always) {
  const Table tables[] = {failures_of(gate), changes_of(gate, ChangeKind::worse, "Worse"), near_budgets(gate),
                          changes_of(gate, ChangeKind::better, "Better")};
  if (!always && tables[0].rows.empty() && tables[1].rows.empty()) return {};
  std::string text = headline(gate) + "\n";
  std::size_t used = 1;
  constexpr std::size_t foot = 2;
  for (const Table& table : tables) used += append(table, summary_lines - foot - used, text);
  text += "\n" +
          std::string(gate.has_baseline
                          ? (gate.settings.same_run ? "Times: of the same run as the baseline's."
                                                    : "Times are not compared: the baseline is of another run.")
                          : "No baseline was given.") +
          "\n";
  return text;
}

}  // namespace kiln
