// SPDX-License-Identifier: GPL-3.0-or-later
#pragma once

#include <string_view>

#include "import/fbx_document.h"

namespace kiln {

/// Reads the records of an FBX text file into `root`. They refer to `text`. Throws BadInput with the line.
void parse_fbx_text(const FbxDocument& document, std::string_view text, FbxRecord& root);

}  // namespace kiln
