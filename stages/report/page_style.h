#pragma once

namespace kiln {

/// Returns the text of report.css.
const char* page_style();

}  // namespace kiln
