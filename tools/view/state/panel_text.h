// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>
#include <vector>

namespace kiln {

/// Row of a panel: a dim label, and the value that it names.
struct PanelRow {
  std::string label;
  std::string value;

  bool operator==(const PanelRow&) const = default;
};

/// Text of a panel.
struct Panel {
  std::string title;  ///< empty: none
  std::vector<PanelRow> rows;

  bool operator==(const Panel&) const = default;
};

}  // namespace kiln
