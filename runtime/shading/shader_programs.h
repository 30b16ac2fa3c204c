// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <vector>

#include "gpu/gl_objects.h"
#include "gpu/program.h"
#include "runtime/shading/shader_glsl.h"

namespace kiln {

/// GL programs of a scene's shaders, compiled on first use.
class ShaderPrograms {
 public:
  /// Compiles every shader by itself, so that faults come to light at once. Throws BadInput for them, MachineLacks
  /// where the device has too few texture units.
  ShaderPrograms(std::vector<SurfaceShader> shaders, const ShadingFeatures& features);

  const ShaderGlsl& glsl() const { return glsl_; }

  const GlProgram& depth();
  const GlProgram& raster(int shader);
  const GlProgram& forward(int shader);
  const GlProgram& deferred(std::uint32_t set);
  const GlProgram& uniforms(int shader);
  const GlProgram& masks();
  const GlProgram& lists();
  const GlProgram& add();

  /// Returns the set of shaders of each list of tiles (shading_lists.comp): every set where there are at most three
  /// shaders, else each shader and then all.
  std::vector<std::uint32_t> sets() const;

 private:
  enum class Pass { depth, raster, forward, deferred, uniforms, masks, lists, add };
  GlProgram made(Pass pass, std::uint32_t which) const;
  const GlProgram& program(Pass pass, std::uint32_t which = 0);

  ShaderGlsl glsl_;
  std::map<std::pair<Pass, std::uint32_t>, GlProgram> programs_;
};

}  // namespace kiln
