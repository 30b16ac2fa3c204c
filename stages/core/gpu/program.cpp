// SPDX-License-Identifier: MIT
#include "gpu/program.h"

#include <stdexcept>

#include "base/errors.h"
#include "gpu/shader_table.h"

namespace kiln {

namespace {

/// Returns the text of a shader with its includes inserted.
std::string expand(std::string_view file, int depth = 0) {
  const std::string_view text = shader_text(file);
  if (text.empty() || depth > 8) throw std::runtime_error("no shader " + std::string(file));
  constexpr std::string_view directive = "#include \"";
  std::string expanded;
  std::size_t begin = 0;
  while (begin < text.size()) {
    const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
    const std::string_view line = text.substr(begin, end - begin);
    if (line.starts_with(directive))
      expanded += expand(line.substr(directive.size(), line.find('"', directive.size()) - directive.size()), depth + 1);
    else
      expanded += line;
    begin = end;
  }
  return expanded;
}

GLenum stage_of(std::string_view file) {
  if (file.ends_with(".vert")) return GL_VERTEX_SHADER;
  if (file.ends_with(".frag")) return GL_FRAGMENT_SHADER;
  if (file.ends_with(".comp")) return GL_COMPUTE_SHADER;
  throw std::runtime_error("shader " + std::string(file) + " has an unknown suffix");
}

}  // namespace

GlProgram load_program(std::initializer_list<std::string_view> files, const ShaderDefines& defines) {
  GlProgram program(glCreateProgram());
  std::string log(8192, '\0');
  GLint good = 0;
  for (std::string_view file : files) {
    std::string text = "#version 450 core\n";
    for (const auto& [name, value] : defines) text += "#define " + name + " " + value + "\n";
    text += expand(file);
    const char* pointer = text.c_str();
    const GLuint shader = glCreateShader(stage_of(file));
    glShaderSource(shader, 1, &pointer, nullptr);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), nullptr, log.data());
    glAttachShader(program.name(), shader);
    glDeleteShader(shader);
    if (good == 0) throw std::runtime_error("shader " + std::string(file) + " does not compile: " + log);
  }
  glLinkProgram(program.name());
  glGetProgramiv(program.name(), GL_LINK_STATUS, &good);
  if (good == 0) {
    glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), nullptr, log.data());
    throw std::runtime_error("shader " + std::string(*files.begin()) + " does not link: " + log);
  }
  return program;
}

GLint uniform_location(const GlProgram& program, const char* name) {
  return glGetUniformLocation(program.name(), name);
}

void check_gl(const char* doing) {
  const GLenum error = glGetError();
  if (error == GL_OUT_OF_MEMORY) throw MachineLacks(std::string("the GL device ran out of memory while ") + doing);
  if (error != GL_NO_ERROR)
    throw std::runtime_error(std::string("GL error ") + std::to_string(error) + " while " + doing);
}

}  // namespace kiln
