// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "gpu/gl_objects.h"

namespace kiln {

/// Lines `#define NAME VALUE` put before a shader's text.
using ShaderDefines = std::vector<std::pair<std::string, std::string>>;

/// Compiles and links the shaders of shaders/ with these file names; the suffix (.vert, .frag, .comp) tells the GPU
/// stage. A line `#include "name"` is replaced by that file. GLSL 4.50 core; the files have no #version line. Throws
/// std::runtime_error with the driver's log.
GlProgram load_program(std::initializer_list<std::string_view> files, const ShaderDefines& defines = {});

/// Returns the location of a uniform of `program`; -1, which glUniform ignores, where it has none.
GLint uniform_location(const GlProgram& program, const char* name);

/// Throws std::runtime_error that names `doing` if GL reports an error; MachineLacks if that error is lack of memory.
void check_gl(const char* doing);

}  // namespace kiln
