// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

#include "kiln/sweep/sweep_result.h"

namespace kiln {

/// Returns all results as data (docs/schema/sweep.schema.json), each with whether it is on the fronts.
Json sweep_json(const std::vector<SweepResult>& results);

/// Makes the page of a sweep: for each asset error against CPU seconds and against bytes, both logarithmic, with the
/// Pareto front, today's settings and the historic ones marked, and a table of all points, the cheapest first.
std::string sweep_html(const std::vector<SweepResult>& results);

}  // namespace kiln
