// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "report/records.h"
#include "report/report.h"

namespace kiln {

/// Make the sections of the page that hold words and numbers; see page_html. HTML.
std::string verification_section(const AssetFolder& asset);
std::string stages_section(const Json& metrics);

}  // namespace kiln
