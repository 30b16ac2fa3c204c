#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/outputs.h"
#include "report/judging.h"
#include "report/report.h"

namespace kiln {

/// Writes the page, its cover and metrics.json. `result` is the report's record so far; gives the record with the
/// stages' records among its inputs.
Json save_report(OutputSet& outputs, const std::string& page_name, const AssetFolder& asset, const Report& report,
                 Json result);

/// What is at `page_file`, where it is a report of the same version, settings and inputs as `result` has (the stages'
/// records as they are now among them) and none of its files has changed since; else nothing.
std::optional<EarlierReport> find_earlier(const std::filesystem::path& page_file, const AssetFolder& asset,
                                          Json result);

}  // namespace kiln
