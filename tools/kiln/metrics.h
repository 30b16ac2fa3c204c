// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <map>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// The metrics that an asset of these settings has for budgets, as "STAGE.METRIC": numbers of the stages' records. A
/// list here, for a budget is checked before any record is there; cli.driver holds it against records.
std::vector<std::string> metrics_of(const AssetSettings& settings);

/// The setting that has a metric written, as "verify-directions of bake"; empty where it takes none.
std::string setting_of_metric(const std::string& metric);

}  // namespace kiln
