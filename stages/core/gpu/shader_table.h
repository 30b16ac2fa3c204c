#pragma once

#include <string_view>

namespace kiln {

/// The text of the file `name` of shaders/, compiled into the program; empty where there is none of that name.
std::string_view shader_text(std::string_view name);

}  // namespace kiln
