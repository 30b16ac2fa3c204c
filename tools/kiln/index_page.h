// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/json.h"

namespace kiln {

/// An asset on the page over all of them.
struct IndexEntry {
  std::string name;
  Json metrics;              ///< content of metrics.json; null if there is no report
  bool has_picture = false;  ///< whether report.png is in its folder
};

/// Makes the page of an output folder: each asset's picture, figures and budgets, with a link to its report. Links are
/// relative, so the folder may be moved.
std::string index_html(const std::string& pipeline, const std::vector<IndexEntry>& entries);

/// Escapes a file name for a URL.
std::string url_escaped(const std::string& name);

}  // namespace kiln
