// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "runtime/shading/shader_file.h"

namespace kiln {

/// What the GLSL of a scene's shaders is made for.
struct ShadingFeatures {
  bool planes = false;    ///< whether a node has precomputed transfer
  bool varyings = false;  ///< whether a shader has varying parameters
  int points = 1;         ///< at which the light of nodes with transfer is computed, as for place_incident_samples
  bool albedo = false, normals = false, opacity = false;  ///< whether an asset ships with a picture of them
  int steps = 3;  ///< for measuring: 3 all, 2 without the part after the light, 1 nor the light, 0 nor the first
};

/// First texture unit of the pictures of shaders; those of shader k follow those of k - 1.
inline constexpr int first_picture_unit = 15;

/// Puts programs for a scene's shaders together, as texts; without GL. Names of shader k get a prefix of their own, so
/// that shaders which share a program cannot meet. Lines keep their number and file by #line.
class ShaderGlsl {
 public:
  ShaderGlsl(std::vector<SurfaceShader> shaders, const ShadingFeatures& features);

  const std::vector<SurfaceShader>& shaders() const { return shaders_; }
  int count() const { return static_cast<int>(shaders_.size()); }

  /// Returns the number of values, of four floats each, that a material of a shader has: its constants, then its
  /// uniform parameters, each in the order of the file.
  int value_count(int shader) const;

  /// Returns the texture unit of a shader's first picture.
  int first_unit(int shader) const;

  /// Texts of shaders, complete with #version.
  std::string surface_vertex() const;
  std::string depth_vertex() const;
  std::string depth_fragment() const;
  std::string raster_fragment(int shader) const;
  std::string forward_fragment(int shader) const;
  /// Shades samples of the shaders whose bits are set, with the light once for all.
  std::string deferred_fragment(std::uint32_t set) const;
  /// Computes the uniform parameters of a shader's materials; only for a shader that has some.
  std::string uniforms_compute(int shader) const;

  bool has_uniforms(int shader) const;

  /// Turns a compiler's log into the fault of the file and line at which it points. `set` has the bits of the shaders
  /// that were compiled. Throws BadInput.
  [[noreturn]] void throw_fault(const std::string& log, std::uint32_t set) const;

 private:
  std::string head(bool computes_uniforms = false) const;
  std::string names_of(int shader, bool computes_uniforms) const;
  std::string body_of(int shader, bool computes_uniforms = false) const;
  std::string varyings_of(int shader) const;
  std::string choices(std::uint32_t set) const;
  std::string prefix(int shader) const { return "s" + std::to_string(shader) + "_"; }
  std::string placed(const std::string& expression, int line, int shader) const;

  std::vector<SurfaceShader> shaders_;
  ShadingFeatures features_;
};

}  // namespace kiln
