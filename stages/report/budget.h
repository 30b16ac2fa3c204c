// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>
#include <vector>

#include "base/json_fwd.h"

namespace kiln {

/// Limit on one metric.
struct Budget {
  std::string metric;  ///< "simplify.hausdorff": a path into metrics.json
  bool is_highest = true;
  double limit = 0;
};

/// Value of a metric, and whether it keeps its budget.
struct BudgetVerdict {
  Budget budget;
  double value = 0;
  bool met = false;
};

/// Reads "METRIC<=NUMBER" or "METRIC>=NUMBER". Throws WrongUsage.
Budget parse_budget(const std::string& text);

/// Looks the metric up in `metrics` (stages by name, their results beneath). A value that is not finite misses its
/// budget; true counts as 1, false as 0. Throws WrongUsage where there is no such number, and lists those that exist.
BudgetVerdict judge_budget(const Budget& budget, const Json& metrics);

/// Judges all texts that parse_budget reads, in order.
std::vector<BudgetVerdict> judge_budgets(const std::vector<std::string>& texts, const Json& metrics);

Json to_json(const BudgetVerdict& verdict);

std::size_t missed_budgets(std::span<const BudgetVerdict> verdicts);

/// Sets `budgets` and `budgets_missed` of the report's result.
void put_verdicts(Json& result, std::span<const BudgetVerdict> verdicts);

}  // namespace kiln
