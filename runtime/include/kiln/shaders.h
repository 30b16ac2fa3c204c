// SPDX-License-Identifier: MIT
#pragma once

#include <string_view>
#include <vector>

#include "kiln/export.h"

namespace kiln::runtime {

/// Lists the GLSL files that draw assets. "common_prt.glsl" comes first: it is all that an engine needs to take over,
/// and describes the textures that it reads.
KILN_RUNTIME_API std::vector<std::string_view> shader_names();

/// Returns the GLSL 4.50 text of a file, empty for an unknown name. Files include one another by `#include "NAME"`
/// (GL_GOOGLE_include_directive).
KILN_RUNTIME_API std::string_view shader_text(std::string_view name);

}  // namespace kiln::runtime
