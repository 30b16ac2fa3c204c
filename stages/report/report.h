// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "report/budget.h"
#include "report/comparison.h"
#include "report/records.h"
#include "report/report_settings.h"

namespace kiln {

/// Content of the report beyond the stages' own results.
struct Report {
  Comparison comparison;
  std::vector<BudgetVerdict> budgets;
  double seconds = 0;

  Json to_json() const;  ///< the report stage's own metrics
};

/// Compares the asset with the high mesh and judges the budgets ("simplify.hausdorff<=0.012"). Throws WrongUsage for a
/// budget of a metric that does not exist, before the work where possible; otherwise throws as compare_with_reference.
Report make_report(const AssetFolder& asset, const std::filesystem::path& high_file,
                   const std::vector<std::string>& budgets, const ReportSettings& settings, const ComparisonRun& run);

/// Returns metrics.json: every stage's result under its name, and `report_result` as the report's.
Json all_metrics(const AssetFolder& asset, const Json& report_result);

}  // namespace kiln
