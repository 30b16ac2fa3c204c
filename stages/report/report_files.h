#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "base/outputs.h"
#include "report/report.h"

namespace kiln {

/// Writes the page, its cover and metrics.json. `result` is the report's record so far; gives the record with the
/// stages' records among its inputs.
Json save_report(OutputSet& outputs, const std::string& page_name, const AssetFolder& asset, const Report& report,
                 Json result);

/// A report that an earlier run left whole.
struct EarlierReport {
  std::string page;
  Json record;  ///< report.json
};

/// What is at `page_file`, where it is a report of the same version, settings and inputs as `result` has (the stages'
/// records as they are now among them) and none of its files has changed since; else nothing.
std::optional<EarlierReport> find_earlier(const std::filesystem::path& page_file, const AssetFolder& asset,
                                          Json result);

/// Writes an earlier report with its metrics judged by other budgets: the page's verdicts, metrics.json and the record,
/// which is given. Its pictures and measures, its time among them, stay what they are. Throws WrongUsage as
/// judge_budget does.
Json save_judged(OutputSet& outputs, const std::string& page_name, const AssetFolder& asset, EarlierReport earlier,
                 const std::vector<std::string>& budgets);

}  // namespace kiln
