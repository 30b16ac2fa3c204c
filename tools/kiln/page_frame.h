// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string>

namespace kiln {

/// A page that the driver writes. Texts are HTML.
struct Page {
  std::string title;
  std::string heading;
  std::string summary;
  std::string style;  ///< rules of this page, after those that all pages share
  std::string content;
};

/// Writes a page in the look of the reports: one file that needs no other.
std::string framed(const Page& page);

}  // namespace kiln
