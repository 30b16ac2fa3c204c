// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <span>
#include <stdexcept>
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

/// Text of a shader from its #version on, for one stage of the GPU, GL_VERTEX_SHADER and so on.
struct ShaderText {
  GLenum stage = 0;
  std::string text;
};

/// GLSL does not compile or link; the message is the driver's log.
class ShaderFault : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Compiles and links shaders that were put together at run time. Throws ShaderFault.
GlProgram compile_program(std::span<const ShaderText> shaders);

/// Returns the text of a file of shaders/ with its includes inserted. Throws std::runtime_error if there is none.
std::string expanded_shader(std::string_view file);

/// Returns the location of a uniform of `program`; -1, which glUniform ignores, where it has none.
GLint uniform_location(const GlProgram& program, const char* name);

/// Throws std::runtime_error that names `doing` if GL reports an error; MachineLacks if that error is lack of memory.
void check_gl(const char* doing);

}  // namespace kiln
