// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>

namespace kiln {

/// Returns the text of the file `name` of shaders/, compiled into the program; empty for unknown names.
std::string_view shader_text(std::string_view name);

}  // namespace kiln
