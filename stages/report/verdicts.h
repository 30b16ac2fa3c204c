// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "base/json_fwd.h"
#include "report/budget.h"

namespace kiln {

/// Return the page's verdict with what to do next, and its budgets as a section, between marks that page_judged_again
/// finds. `metrics` is that of all_metrics. HTML.
std::string marked_verdict(std::span<const BudgetVerdict> verdicts, const Json& metrics);
std::string marked_budgets(std::span<const BudgetVerdict> verdicts);

/// Returns a page with its verdicts on budgets replaced.
std::string page_judged_again(const std::string& html, std::span<const BudgetVerdict> verdicts, const Json& metrics);

}  // namespace kiln
