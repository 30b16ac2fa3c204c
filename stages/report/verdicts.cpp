// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/verdicts.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>

#include "base/html.h"
#include "base/json.h"
#include "report/labels.h"
#include "report/next_steps.h"

namespace kiln {

namespace {

constexpr const char* verdict_mark = "verdict";
constexpr const char* budgets_mark = "budgets";

const char* plural(std::size_t count) { return count == 1 ? "" : "s"; }

std::string badge(std::span<const BudgetVerdict> verdicts) {
  const std::size_t count = verdicts.size(), missed = missed_budgets(verdicts);
  if (count == 0) return "<span class='badge plain'>No budgets set</span>";
  if (missed == 0)
    return fmt::format("<span class='badge good'>✓ {}</span>",
                       count == 1 ? "Budget met" : fmt::format("All {} budgets met", count));
  return fmt::format("<span class='badge bad'>✗ {} of {} budget{} missed</span>", missed, count, plural(count));
}

std::string verdict(std::span<const BudgetVerdict> verdicts, const Json& metrics) {
  return badge(verdicts) + "\n" + next_steps(verdicts, metrics);
}

/// Returns the used share of a budget: 1 is all of it.
double budget_use(const BudgetVerdict& verdict) {
  const double use =
      verdict.budget.is_highest ? verdict.value / verdict.budget.limit : verdict.budget.limit / verdict.value;
  return std::isfinite(use) && use >= 0 ? use : verdict.met ? 0 : 1;
}

std::string budgets_section(std::span<const BudgetVerdict> verdicts) {
  std::string html = "<section><h2>Budgets</h2>\n";
  if (verdicts.empty())
    return html +
           "<p class=note>None are set for this asset. pipeline.yaml takes them as <code>budgets: {STAGE.METRIC: {max: "
           "…}}</code>.</p></section>\n";
  html +=
      "<table class='folding sortable'><thead><tr><th>Metric<th class=number>Value<th "
      "class=number>Limit<th>Used<th>Verdict</thead><tbody>\n";
  for (const BudgetVerdict& verdict : verdicts) {
    const std::string& key = verdict.budget.metric;
    const char* tone = verdict.met ? "good" : "bad";
    html += fmt::format(
        "<tr><td><b>{}</b> <code>{}</code><td class=number data-label=Value>{}<td class=number data-label=Limit>{} "
        "{}<td data-label=Used><div class='meter {}'><i style='width:{:.0f}%'></i></div>"
        "<td class='verdict {}' data-label=Verdict>{}\n",
        html_escaped(metric_label(key)), html_escaped(key), metric_value(key, verdict.value),
        verdict.budget.is_highest ? "≤" : "≥", metric_value(key, verdict.budget.limit), tone,
        100 * std::min(1.0, budget_use(verdict)), tone, verdict.met ? "met" : "missed");
  }
  return html + "</tbody></table></section>\n";
}

std::string begin_of(const char* part) { return fmt::format("<!--{}-->", part); }
std::string end_of(const char* part) { return fmt::format("<!--/{}-->", part); }

/// Wraps a part of the page in marks, so that page_judged_again can replace it.
std::string marked(const char* part, const std::string& html) { return begin_of(part) + html + end_of(part); }

void replace(std::string& page, const char* part, const std::string& html) {
  const std::size_t begin = page.find(begin_of(part)), end = page.find(end_of(part));
  if (begin == std::string::npos || end == std::string::npos)
    throw std::logic_error("a report's page lacks the marks of its verdicts");
  page.replace(begin, end + end_of(part).size() - begin, marked(part, html));
}

}  // namespace

std::string marked_verdict(std::span<const BudgetVerdict> verdicts, const Json& metrics) {
  return marked(verdict_mark, verdict(verdicts, metrics));
}

std::string marked_budgets(std::span<const BudgetVerdict> verdicts) {
  return marked(budgets_mark, budgets_section(verdicts));
}

std::string page_judged_again(const std::string& html, std::span<const BudgetVerdict> verdicts, const Json& metrics) {
  std::string page = html;
  replace(page, verdict_mark, verdict(verdicts, metrics));
  replace(page, budgets_mark, budgets_section(verdicts));
  return page;
}

}  // namespace kiln
