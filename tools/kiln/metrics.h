#pragma once

#include <map>
#include <string>
#include <vector>

#include "kiln/stages.h"

namespace kiln {

/// The metrics that an asset of these settings has for budgets, as "STAGE.METRIC": numbers of the stages' records. A
/// list here, for a budget is checked before any record is there; cli.metrics holds it against records.
std::vector<std::string> metrics_of(const std::map<Stage, StageSettings>& settings);

}  // namespace kiln
