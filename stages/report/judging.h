#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/outputs.h"
#include "report/budget.h"

namespace kiln {

/// A report that an earlier run left whole.
struct EarlierReport {
  std::string page;
  Json metrics;  ///< metrics.json
  Json record;   ///< report.json
};

/// Files beside the page.
inline constexpr const char* report_cover = "report.png";
inline constexpr const char* report_metrics = "metrics.json";
inline constexpr const char* report_record = "report.json";

/// Throws BadInput where one of the files cannot be read.
EarlierReport load_earlier(const std::filesystem::path& page_file);

/// Writes an earlier report with its metrics judged by other budgets: the page's verdicts, metrics.json and, where it
/// is not left to the caller, the record, which is given. Its pictures and measures, its time among them, stay what
/// they are. Throws WrongUsage as judge_budget does.
Json save_judged(OutputSet& outputs, const std::string& page_name, EarlierReport earlier,
                 const std::vector<std::string>& budgets);

/// All of it in place: the report at `page_file` judged by `budgets`. Throws as both do.
void judge_anew(const std::filesystem::path& page_file, const std::vector<std::string>& budgets);

}  // namespace kiln
