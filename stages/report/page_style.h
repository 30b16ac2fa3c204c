#pragma once

namespace kiln {

/// The text of report.css.
const char* page_style();

}  // namespace kiln
