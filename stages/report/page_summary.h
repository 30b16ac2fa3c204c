// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"
#include "report/records.h"
#include "report/report.h"

namespace kiln {

/// Makes the first screen of the page: the asset, the verdict and what to do next, its error and where that comes from,
/// what it costs, and when and where it was made. `cover` is an <img> of the asset; `metrics` is that of all_metrics.
/// HTML.
std::string page_summary(const AssetFolder& asset, const Report& report, const Json& metrics, const std::string& cover);

}  // namespace kiln
