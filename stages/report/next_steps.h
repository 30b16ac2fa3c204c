// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string>

#include "base/json_fwd.h"
#include "report/budget.h"

namespace kiln {

/// Says what to do next: a line for each budget that is missed, with what would help, and the setting that would bring
/// the asset nearest to the original. `metrics` is that of all_metrics. HTML.
std::string next_steps(std::span<const BudgetVerdict> verdicts, const Json& metrics);

}  // namespace kiln
