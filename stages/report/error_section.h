// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

#include "report/comparison.h"

namespace kiln {

/// Makes the page's section on E and its causes; says why where they were not measured. HTML.
std::string error_section(const Comparison& comparison);

}  // namespace kiln
