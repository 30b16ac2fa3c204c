// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

namespace kiln {

/// Returns the text of report.css.
const char* page_style();

}  // namespace kiln
