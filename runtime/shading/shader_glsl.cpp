// SPDX-License-Identifier: MIT
#include "runtime/shading/shader_glsl.h"

#include <cstdio>
#include <sstream>
#include <utility>

#include "base/errors.h"
#include "gpu/program.h"
#include "runtime/light/incident_samples.h"

namespace kiln {

namespace {

using Kind = ShaderParameter::Kind;

/// Returns `count` components of a vector from `first` on: ".yz".
std::string swizzle(int first, int count) {
  return "." + std::string("xyzw").substr(static_cast<std::size_t>(first), static_cast<std::size_t>(count));
}

// Lines of the file of shader k are numbered from this times k + 1 on: drivers lose the number of the file that #line
// may give beside that of the line (Mesa 22).
constexpr int lines_per_file = 1'000'000;

/// Reads "FILE:LINE(COLUMN): error: MESSAGE" and what other drivers write. Returns the message; empty for other lines.
std::string parsed_error(const std::string& text, int& file, int& line) {
  for (const char* pattern : {"%d:%d(%*d): error: %n", "%d(%d) : error %*[A-Z0-9]: %n", "ERROR: %d:%d: %n"}) {
    int length = 0;
    if (std::sscanf(text.c_str(), pattern, &file, &line, &length) != 2 || length == 0) continue;
    file = line / lines_per_file;
    line %= lines_per_file;
    return text.substr(static_cast<std::size_t>(length));
  }
  return {};
}

}  // namespace

ShaderGlsl::ShaderGlsl(std::vector<SurfaceShader> shaders, const ShadingFeatures& features)
    : shaders_(std::move(shaders)), features_(features) {}

int ShaderGlsl::value_count(int shader) const {
  int count = 0;
  for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters)
    if (parameter.kind == Kind::constant || parameter.kind == Kind::uniform) ++count;
  return count;
}

int ShaderGlsl::first_unit(int shader) const {
  int unit = first_picture_unit;
  for (int k = 0; k < shader; ++k)
    for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(k)].parameters)
      if (parameter.kind == Kind::texture) ++unit;
  return unit;
}

bool ShaderGlsl::has_uniforms(int shader) const {
  for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters)
    if (parameter.kind == Kind::uniform) return true;
  return false;
}

std::string ShaderGlsl::head(bool computes_uniforms) const {
  std::string text = "#version 450 core\n";
  if (features_.planes) text += "#define SHADING_PRT\n";
  if (features_.varyings) text += "#define SHADING_VARYINGS\n";
  if (features_.points != 1) text += "#define SHADING_POINTS " + std::to_string(features_.points) + "\n";
  if (features_.points == samples_at_vertices) text += "#define SHADING_AT_VERTICES\n";
  if (features_.albedo) text += "#define SHADING_ALBEDO\n";
  if (features_.normals) text += "#define SHADING_NORMALS\n";
  if (features_.opacity) text += "#define SHADING_OPACITY\n";
  if (computes_uniforms) text += "#define SHADING_UNIFORMS\n";
  text += "#define SHADING_STEPS " + std::to_string(features_.steps) + "\n";
  return text + expanded_shader("shading_scene.glsl");
}

/// Defines what a shader's parameters stand for.
std::string ShaderGlsl::names_of(int shader, bool computes_uniforms) const {
  std::string text;
  int unit = first_unit(shader), varying = 0, slot = 0;
  const auto define = [&](const ShaderParameter& parameter, const std::string& meaning) {
    text += "#define " + prefix(shader) + parameter.name + " " + meaning + "\n";
  };
  for (const Kind kind : {Kind::constant, Kind::uniform})
    for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters) {
      if (parameter.kind != kind) continue;
      const std::string place = "kiln_material + " + std::to_string(slot++);
      const std::string value =
          (computes_uniforms ? "kiln_values[" + place + "]" : "texelFetch(material_values, " + place + ")") +
          swizzle(0, component_count(parameter.type));
      define(parameter, parameter.type == ShaderType::integer ? "int(" + value + ")" : value);
    }
  for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters) {
    if (parameter.kind == Kind::varying) {
      define(parameter, "kiln_varyings" + swizzle(varying, component_count(parameter.type)));
      varying += component_count(parameter.type);
    } else if (parameter.kind == Kind::texture) {
      text += "layout(binding = " + std::to_string(unit++) + ") uniform sampler2D " + prefix(shader) + parameter.name +
              ";\n";
    }
  }
  return text;
}

std::string ShaderGlsl::placed(const std::string& glsl, int line, int shader) const {
  return "\n#line " + std::to_string(lines_per_file * (shader + 1) + line) + "\n" +
         with_prefix(glsl, shaders_[static_cast<std::size_t>(shader)].names, prefix(shader)) + "\n#line 1\n";
}

/// Returns a shader's parameters and its own GLSL.
std::string ShaderGlsl::body_of(int shader, bool computes_uniforms) const {
  return names_of(shader, computes_uniforms) + placed(shaders_[static_cast<std::size_t>(shader)].text, 1, shader);
}

/// Returns a function that computes a shader's varying parameters.
std::string ShaderGlsl::varyings_of(int shader) const {
  std::string text = "vec4 varyings_of(Surface surface) {\nvec4 kiln_all = vec4(0.0);\n";
  int first = 0;
  for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters) {
    if (parameter.kind != Kind::varying) continue;
    const int count = component_count(parameter.type);
    const std::string own = "kiln_own" + std::to_string(first);
    text += placed(std::string(glsl_type(parameter.type)) + " " + own + " = " + parameter.expression + ";",
                   parameter.line, shader) +
            "kiln_all" + swizzle(first, count) + " = " + own + ";\n";
    first += count;
  }
  return text + "return kiln_all;\n}\n";
}

/// Returns functions that run the part of the sample's shader among a set of them.
std::string ShaderGlsl::choices(std::uint32_t set) const {
  std::string among, before, after;
  for (int k = 0; k < count(); ++k) {
    if ((set >> static_cast<unsigned>(k) & 1u) == 0) continue;
    const std::string is_it = "shader == " + std::to_string(k);
    const bool is_alone = set == 1u << static_cast<unsigned>(k);
    among += (among.empty() ? "" : " || ") + is_it;
    const std::string condition = is_alone ? "  " : "  if (" + is_it + ") ";
    before += condition + prefix(k) + "before_light(surface, appearance);\n";
    after += condition + (is_alone ? "return " : "color = ") + prefix(k) + "after_light(surface, appearance, light);\n";
  }
  const bool is_one = (set & (set - 1)) == 0;
  return "bool is_among(int shader) {\n  return " + among + ";\n}\n" +
         "void run_before(int shader, Surface surface, inout Appearance appearance) {\n" + before + "}\n" +
         "vec3 run_after(int shader, Surface surface, Appearance appearance, Light light) {\n" +
         (is_one ? after : "  vec3 color = vec3(0.0);\n" + after + "  return color;\n") + "}\n";
}

std::string ShaderGlsl::surface_vertex() const { return head() + expanded_shader("shading_surface.vert"); }

std::string ShaderGlsl::depth_vertex() const {
  std::string text = head();
  text.insert(text.find('\n') + 1, "#define SHADING_DEPTH\n");
  return text + expanded_shader("shading_surface.vert");
}

std::string ShaderGlsl::depth_fragment() const { return head() + expanded_shader("shading_depth.frag"); }

std::string ShaderGlsl::raster_fragment(int shader) const {
  return head() + expanded_shader("shading_fragment.glsl") + body_of(shader) + varyings_of(shader) +
         expanded_shader("shading_raster.frag");
}

std::string ShaderGlsl::forward_fragment(int shader) const {
  return head() + expanded_shader("shading_light.glsl") + expanded_shader("shading_fragment.glsl") + body_of(shader) +
         varyings_of(shader) + choices(1u << static_cast<unsigned>(shader)) + expanded_shader("shading_shade.glsl") +
         expanded_shader("shading_forward.frag");
}

std::string ShaderGlsl::deferred_fragment(std::uint32_t set) const {
  std::string text = head() + expanded_shader("shading_light.glsl");
  for (int k = 0; k < count(); ++k)
    if ((set >> static_cast<unsigned>(k) & 1u) != 0) text += body_of(k);
  return text + choices(set) + expanded_shader("shading_shade.glsl") + expanded_shader("shading_deferred.frag");
}

std::string ShaderGlsl::uniforms_compute(int shader) const {
  std::string text = head(true) + body_of(shader, true) + "void store_uniforms() {\n";
  int slot = 0;
  for (const Kind kind : {Kind::constant, Kind::uniform})
    for (const ShaderParameter& parameter : shaders_[static_cast<std::size_t>(shader)].parameters) {
      if (parameter.kind != kind) continue;
      const std::string number = std::to_string(slot++);
      if (kind == Kind::constant) continue;
      text += placed(std::string(glsl_type(parameter.type)) + " kiln_own" + number + " = " + parameter.expression + ";",
                     parameter.line, shader) +
              "kiln_values[kiln_material + " + number + "]" + swizzle(0, component_count(parameter.type)) + " = " +
              (parameter.type == ShaderType::integer ? "float(kiln_own" + number + ")" : "kiln_own" + number) + ";\n";
    }
  return text + "}\n" + expanded_shader("shading_uniforms.comp");
}

void ShaderGlsl::throw_fault(const std::string& log, std::uint32_t set) const {
  std::istringstream lines(log);
  for (std::string text; std::getline(lines, text);) {
    int file = 0, line = 0;
    std::string message = parsed_error(text, file, line);
    if (message.empty() || file < 1 || file > count()) continue;
    // Names as the file has them.
    const std::string mark = prefix(file - 1);
    for (std::size_t at = message.find(mark); at != std::string::npos; at = message.find(mark, at))
      message.erase(at, mark.size());
    throw BadInput(shaders_[static_cast<std::size_t>(file - 1)].file.string() + ":" + std::to_string(line),
                   "the GLSL compiler says: " + message, "GLSL 4.50 that compiles", "correct the line");
  }
  for (int k = 0; k < count(); ++k)
    if ((set >> static_cast<unsigned>(k) & 1u) != 0)
      throw BadInput(shaders_[static_cast<std::size_t>(k)].file.string(), "the GLSL compiler says: " + log,
                     "GLSL 4.50 that compiles", "correct the shader");
  throw std::runtime_error("Kiln's own shading GLSL does not compile: " + log);
}

}  // namespace kiln
