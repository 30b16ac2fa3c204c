// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"
#include "base/outputs.h"
#include "report/budget.h"

namespace kiln {

/// Whole report that an earlier run wrote.
struct EarlierReport {
  std::string page;
  Json metrics;  ///< metrics.json
  Json record;   ///< report.json
};

/// Name of the picture beside the page.
inline constexpr const char* report_cover = "report.png";
inline constexpr const char* report_metrics = "metrics.json";
inline constexpr const char* report_record = "report.json";

/// Loads a report. Throws BadInput where one of the files cannot be read.
EarlierReport load_earlier(const std::filesystem::path& page_file);

/// Writes an earlier report with its metrics judged by other budgets: the page's verdicts, metrics.json and, unless the
/// caller writes it, the record, which is returned. Its pictures and measures, including its time, are unchanged.
/// Throws WrongUsage as judge_budget does.
Json save_judged(OutputSet& outputs, const std::string& page_name, EarlierReport earlier,
                 const std::vector<std::string>& budgets);

/// Judges the report at `page_file` by `budgets`, in place. Throws as load_earlier and save_judged do.
void judge_anew(const std::filesystem::path& page_file, const std::vector<std::string>& budgets);

}  // namespace kiln
