// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// Lists the metrics that budgets of an asset with these settings may name, as "STAGE.METRIC": numbers of the stages'
/// records. A list in code, because budgets are checked before any record exists; the test cli.driver compares it with
/// records.
std::vector<std::string> metrics_of(const AssetSettings& settings);

/// Returns the setting that a metric depends on, as "verify-directions of bake"; empty if there is none.
std::string setting_of_metric(const std::string& metric);

}  // namespace kiln
