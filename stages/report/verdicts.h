// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "report/budget.h"

namespace kiln {

/// Return the page's budgets as a badge and as a section, between marks that page_judged_again finds. HTML.
std::string marked_badge(std::span<const BudgetVerdict> verdicts);
std::string marked_budgets(std::span<const BudgetVerdict> verdicts);

/// Returns a page with its verdicts on budgets replaced.
std::string page_judged_again(const std::string& html, std::span<const BudgetVerdict> verdicts);

}  // namespace kiln
