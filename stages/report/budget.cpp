// SPDX-License-Identifier: GPL-3.0-or-later
#include "report/budget.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <sstream>

#include "base/errors.h"
#include "base/json.h"

namespace kiln {

namespace {

bool is_measure(const Json& value) { return value.is_number() || value.is_boolean() || value.is_null(); }

std::string names_of_metrics(const Json& json) {
  std::string names;
  for (const auto& [key, value] : json.items())
    if (is_measure(value)) names += (names.empty() ? "" : ", ") + key;
  return names;
}

}  // namespace

Budget parse_budget(const std::string& text) {
  const std::size_t sign = text.find_first_of("<>");
  Budget budget;
  if (sign != std::string::npos && sign > 0 && text.compare(sign + 1, 1, "=") == 0) {
    budget.metric = text.substr(0, sign);
    budget.is_highest = text[sign] == '<';
    const char* begin = text.data() + sign + 2;
    const char* end = text.data() + text.size();
    const auto [stopped, error] = std::from_chars(begin, end, budget.limit);
    if (error == std::errc() && stopped == end && std::isfinite(budget.limit)) return budget;
  }
  throw WrongUsage("budget: found '" + text +
                   "'; expected METRIC<=NUMBER or METRIC>=NUMBER, as in simplify.hausdorff<=0.01");
}

BudgetVerdict judge_budget(const Budget& budget, const Json& metrics) {
  const Json* at = &metrics;
  std::istringstream path(budget.metric);
  for (std::string key, walked; std::getline(path, key, '.'); walked += (walked.empty() ? "" : ".") + key) {
    if (!at->is_object() || !at->contains(key)) {
      const std::string names = walked.empty() ? "a stage: simplify, atlas, normals, bake, compress and probes (where "
                                                 "kiln-report is given them) or report"
                                               : walked + ".*: " + names_of_metrics(*at);
      throw WrongUsage("budget: found the metric '" + budget.metric + "'; expected one of " + names);
    }
    at = &(*at)[key];
  }
  if (!is_measure(*at))
    throw WrongUsage("budget: found the metric '" + budget.metric + "', which is no number; expected one");
  BudgetVerdict verdict;
  verdict.budget = budget;
  if (at->is_null())
    verdict.value = std::numeric_limits<double>::quiet_NaN();  // the JSON has null for it
  else
    verdict.value = at->is_boolean() ? static_cast<double>(at->get<bool>()) : at->get<double>();
  verdict.met = budget.is_highest ? verdict.value <= budget.limit : verdict.value >= budget.limit;
  return verdict;
}

std::vector<BudgetVerdict> judge_budgets(const std::vector<std::string>& texts, const Json& metrics) {
  std::vector<BudgetVerdict> verdicts;
  for (const std::string& text : texts) verdicts.push_back(judge_budget(parse_budget(text), metrics));
  return verdicts;
}

std::size_t missed_budgets(std::span<const BudgetVerdict> verdicts) {
  return static_cast<std::size_t>(
      std::count_if(verdicts.begin(), verdicts.end(), [](const BudgetVerdict& verdict) { return !verdict.met; }));
}

void put_verdicts(Json& result, std::span<const BudgetVerdict> verdicts) {
  result["budgets"] = Json::array();
  for (const BudgetVerdict& verdict : verdicts) result["budgets"].push_back(to_json(verdict));
  result["budgets_missed"] = missed_budgets(verdicts);
}

Json to_json(const BudgetVerdict& verdict) {
  return {{"metric", verdict.budget.metric},
          {"value", verdict.value},
          {"relation", verdict.budget.is_highest ? "at most" : "at least"},
          {"limit", verdict.budget.limit},
          {"met", verdict.met}};
}

}  // namespace kiln
