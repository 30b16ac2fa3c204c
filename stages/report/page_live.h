// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "base/json_fwd.h"
#include "report/records.h"
#include "report/report.h"

namespace kiln {

/// Makes the end of the page: the files of the asset that a script draws live in place of the first picture, its
/// compressed form where there is one, and the script itself. An asset of more than 8 MB is left out, and said to be.
/// `settings` are the report's. HTML.
std::string page_live(const AssetFolder& asset, const Report& report, const Json& settings);

}  // namespace kiln
