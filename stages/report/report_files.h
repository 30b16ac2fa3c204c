// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "base/outputs.h"
#include "report/judging.h"
#include "report/report.h"

namespace kiln {

/// Writes the page, its cover and metrics.json. `result` is the report's record so far; returns the record with the
/// stages' records among its inputs.
Json save_report(OutputSet& outputs, const std::string& page_name, const AssetFolder& asset, const Report& report,
                 Json result);

/// Returns the report at `page_file` if it has the same version, settings and inputs as `result` (including the stages'
/// present records) and none of its files has changed since; else nothing.
std::optional<EarlierReport> find_earlier(const std::filesystem::path& page_file, const AssetFolder& asset,
                                          Json result);

}  // namespace kiln
