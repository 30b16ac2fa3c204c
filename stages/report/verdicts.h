#pragma once

#include <span>
#include <string>

#include "report/budget.h"

namespace kiln {

/// What the page says of budgets, in a word and in a section, between marks that page_judged_again finds. HTML.
std::string marked_badge(std::span<const BudgetVerdict> verdicts);
std::string marked_budgets(std::span<const BudgetVerdict> verdicts);

/// A page with other verdicts on the budgets in place of those it has.
std::string page_judged_again(const std::string& html, std::span<const BudgetVerdict> verdicts);

}  // namespace kiln
