// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace kiln {

/// Type of a declared parameter of a shader.
enum class ShaderType { real, integer, vec2, vec3, vec4 };

/// Returns its name in GLSL, and its number of components, 1 to 4.
const char* glsl_type(ShaderType type);
int component_count(ShaderType type);

/// Number, vector or integer that a parameter has; components beyond those of its type are 0.
using ShaderValue = std::array<float, 4>;

/// A parameter that a shader's file declares. [Lastra 1995], 3.3: what is constant over a surface is sent once, what
/// varies is interpolated by rasterisation, and what follows from constants alone is computed once a frame.
struct ShaderParameter {
  enum class Kind {
    constant,  ///< one value for each material: `parameter TYPE NAME = VALUE [in LOWEST to HIGHEST];`
    uniform,   ///< computed once a frame for each material: `uniform TYPE NAME = EXPRESSION;`
    varying,   ///< computed by rasterisation: `varying TYPE NAME = EXPRESSION;`
    texture,   ///< a picture: `texture NAME = "FILE" [linear] [clamped];`
  };
  Kind kind = Kind::constant;
  ShaderType type = ShaderType::real;
  std::string name;
  int line = 0;             ///< from 1
  ShaderValue value = {};   ///< default of a constant
  float lowest = 0;         ///< of a constant's components, if has_range
  float highest = 0;        ///< the same
  bool has_range = false;   ///< whether a constant's values are bounded
  std::string expression;   ///< GLSL, of uniform and varying parameters
  std::string picture;      ///< file of a texture, relative to the shader's folder
  bool is_linear = false;   ///< whether the picture holds numbers; else it is decoded from sRGB
  bool is_clamped = false;  ///< whether lookups beyond the unit square give its border; else the picture repeats
};

/// An appearance shader: parameters, and GLSL with a part before the light and a part after it ([Lastra 1995], figure
/// 7). docs/shaders.md is the page for those who write them.
struct SurfaceShader {
  std::filesystem::path file;
  std::string name;  ///< the file's name without its ending
  std::vector<ShaderParameter> parameters;
  std::set<std::string> names;  ///< all that the file defines: parameters, functions, global variables, macros
  std::string text;             ///< GLSL without comments and declarations of parameters, line for line as the file

  /// Returns the parameter of that name, or null.
  const ShaderParameter* find(const std::string& wanted) const;

  /// Returns the number of components of all varying parameters.
  int varying_components() const;
};

/// Most components of the varying parameters of one shader.
inline constexpr int most_varying_components = 4;

/// Reads a shader's file. Throws BadInput, whose file is "FILE:LINE", for what is not a declaration or GLSL's outline:
/// unknown types, names declared twice, values out of range, braces without partner, a missing part.
SurfaceShader read_shader(const std::filesystem::path& file);

/// Parses the text of such a file.
SurfaceShader parse_shader(const std::string& text, const std::filesystem::path& file);

/// Reads all files FOLDER/*.glsl, sorted by name. Throws BadInput as read_shader does, and where there is none.
std::vector<SurfaceShader> read_shaders(const std::filesystem::path& folder);

/// Puts `prefix` before every word of `glsl` that is among `names` and no member of something.
std::string with_prefix(const std::string& glsl, const std::set<std::string>& names, const std::string& prefix);

}  // namespace kiln
