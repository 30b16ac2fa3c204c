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

GlProgram compile_program(std::span<const ShaderText> shaders) {
  GlProgram program(glCreateProgram());
  std::string log(8192, '\0');
  GLint good = 0;
  GLsizei length = 0;
  for (const ShaderText& part : shaders) {
    const char* pointer = part.text.c_str();
    const GLuint shader = glCreateShader(part.stage);
    glShaderSource(shader, 1, &pointer, nullptr);
    glCompileShader(shader);
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good == 0) glGetShaderInfoLog(shader, static_cast<GLsizei>(log.size()), &length, log.data());
    glAttachShader(program.name(), shader);
    glDeleteShader(shader);
    if (good == 0) throw ShaderFault(log.substr(0, static_cast<std::size_t>(length)));
  }
  glLinkProgram(program.name());
  glGetProgramiv(program.name(), GL_LINK_STATUS, &good);
  if (good == 0) {
    glGetProgramInfoLog(program.name(), static_cast<GLsizei>(log.size()), &length, log.data());
    throw ShaderFault(log.substr(0, static_cast<std::size_t>(length)));
  }
  return program;
}

std::string expanded_shader(std::string_view file) { return expand(file); }

GlProgram load_program(std::initializer_list<std::string_view> files, const ShaderDefines& defines) {
  std::vector<ShaderText> shaders;
  for (std::string_view file : files) {
    std::string text = "#version 450 core\n";
    for (const auto& [name, value] : defines) text += "#define " + name + " " + value + "\n";
    shaders.push_back({stage_of(file), text + expand(file)});
  }
  try {
    return compile_program(shaders);
  } catch (const ShaderFault& fault) {
    throw std::runtime_error("shader " + std::string(*files.begin()) + " and those linked to it: " + fault.what());
  }
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
