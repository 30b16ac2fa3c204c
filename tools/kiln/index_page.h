// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/options.h"

namespace kiln {

/// An asset as the page over all of them shows it.
struct IndexEntry {
  std::string name;
  Json metrics;              ///< its metrics.json; null where there is no report
  bool has_picture = false;  ///< report.png in its folder
};

/// The page of an output folder: each asset's picture, figures and budgets, with a link to its report. Links are
/// relative, so the folder may be moved.
std::string index_html(const std::string& pipeline, const std::vector<IndexEntry>& entries);

/// Text in HTML.
std::string html_escaped(const std::string& text);

/// A file name in a URL.
std::string url_escaped(const std::string& name);

}  // namespace kiln
