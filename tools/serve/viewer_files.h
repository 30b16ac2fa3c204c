// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <span>
#include <string_view>

namespace kiln {

/// File of the viewer page, as tools/web builds it.
struct ViewerFile {
  std::string_view path;  ///< relative to the page's folder, "index.html" for the page itself
  std::string_view bytes;
};

/// Returns the files of the viewer page, which are part of the program.
std::span<const ViewerFile> viewer_files();

}  // namespace kiln
