// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "kiln/export.h"

namespace kiln::runtime {

/// Names of the GLSL files that draw assets, "common_prt.glsl" first: it is all that an engine has to take over, and
/// says what textures it reads.
KILN_RUNTIME_API std::vector<std::string_view> shader_names();

/// GLSL 4.50 text of one of them, empty for a name that is none. Files include one another by
/// #include "NAME" (GL_GOOGLE_include_directive).
KILN_RUNTIME_API std::string_view shader_text(std::string_view name);

}  // namespace kiln::runtime
