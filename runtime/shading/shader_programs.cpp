// SPDX-License-Identifier: MIT
#include "runtime/shading/shader_programs.h"

#include <bit>
#include <utility>

#include "base/errors.h"
#include "runtime/shading/shaded_frame.h"

namespace kiln {

namespace {

// Shaders that a tile's mask of 32 bits tells apart, and up to which every set of them has a list of tiles.
constexpr int most_shaders = 32, most_with_all_sets = 3;

}  // namespace

ShaderPrograms::ShaderPrograms(std::vector<SurfaceShader> shaders, const ShadingFeatures& features)
    : glsl_(std::move(shaders), features) {
  if (glsl_.count() > most_shaders)
    throw WrongUsage("shaders: found " + std::to_string(glsl_.count()) + " in one scene; expected at most " +
                     std::to_string(most_shaders));
  GLint units = 0;
  glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
  if (glsl_.first_unit(glsl_.count()) > units)
    throw MachineLacks("the shaders look at " + std::to_string(glsl_.first_unit(glsl_.count()) - first_picture_unit) +
                       " pictures, and the GL device has units for " + std::to_string(units - first_picture_unit) +
                       "; put several into one picture");
  GLfloat point_sizes[2] = {0, 0};
  glGetFloatv(GL_POINT_SIZE_RANGE, point_sizes);
  if (point_sizes[1] < shading_tile_side)
    throw MachineLacks("the GL device draws points of at most " + std::to_string(point_sizes[1]) +
                       " samples, and tiles have " + std::to_string(shading_tile_side) + "; try --gl-device software");
  for (int k = 0; k < glsl_.count(); ++k) {
    raster(k);
    deferred(1u << static_cast<unsigned>(k));
    if (glsl_.has_uniforms(k)) uniforms(k);
  }
}

const GlProgram& ShaderPrograms::depth() { return program(Pass::depth); }
const GlProgram& ShaderPrograms::raster(int shader) {
  return program(Pass::raster, 1u << static_cast<unsigned>(shader));
}
const GlProgram& ShaderPrograms::forward(int shader) {
  return program(Pass::forward, 1u << static_cast<unsigned>(shader));
}
const GlProgram& ShaderPrograms::deferred(std::uint32_t set) { return program(Pass::deferred, set); }
const GlProgram& ShaderPrograms::uniforms(int shader) {
  return program(Pass::uniforms, 1u << static_cast<unsigned>(shader));
}
const GlProgram& ShaderPrograms::masks() { return program(Pass::masks); }
const GlProgram& ShaderPrograms::lists() { return program(Pass::lists); }
const GlProgram& ShaderPrograms::add() { return program(Pass::add); }

std::vector<std::uint32_t> ShaderPrograms::sets() const {
  std::vector<std::uint32_t> sets;
  const auto count = static_cast<unsigned>(glsl_.count());
  if (glsl_.count() <= most_with_all_sets) {
    for (std::uint32_t set = 1; set < 1u << count; ++set) sets.push_back(set);
  } else {
    std::uint32_t all = 0;
    for (unsigned k = 0; k < count; ++k) {
      sets.push_back(1u << k);
      all |= 1u << k;
    }
    sets.push_back(all);
  }
  return sets;
}

const GlProgram& ShaderPrograms::program(Pass pass, std::uint32_t which) {
  const auto found = programs_.find({pass, which});
  if (found != programs_.end()) return found->second;
  return programs_.emplace(std::pair{pass, which}, made(pass, which)).first->second;
}

GlProgram ShaderPrograms::made(Pass pass, std::uint32_t which) const {
  ShaderDefines defines = {{"SHADING_SHADERS", std::to_string(glsl_.count())}};
  if (glsl_.count() <= most_with_all_sets) defines.emplace_back("SHADING_ALL_SETS", "1");
  if (pass == Pass::masks) return load_program({"shading_masks.comp"});
  if (pass == Pass::lists) return load_program({"shading_lists.comp"}, defines);
  if (pass == Pass::add) return load_program({"render_deferred.vert", "shading_add.frag"});
  const auto compiled = [&](const std::vector<ShaderText>& texts) {
    try {
      return compile_program(texts);
    } catch (const ShaderFault& fault) {
      glsl_.throw_fault(fault.what(), which);
    }
  };
  const int shader = which == 0 ? 0 : std::countr_zero(which);
  const std::string tiles = "#version 450 core\n" + expanded_shader("shading_tiles.vert");
  switch (pass) {
    case Pass::depth:
      return compiled({{GL_VERTEX_SHADER, glsl_.depth_vertex()}, {GL_FRAGMENT_SHADER, glsl_.depth_fragment()}});
    case Pass::raster:
      return compiled(
          {{GL_VERTEX_SHADER, glsl_.surface_vertex()}, {GL_FRAGMENT_SHADER, glsl_.raster_fragment(shader)}});
    case Pass::forward:
      return compiled(
          {{GL_VERTEX_SHADER, glsl_.surface_vertex()}, {GL_FRAGMENT_SHADER, glsl_.forward_fragment(shader)}});
    case Pass::uniforms:
      return compiled({{GL_COMPUTE_SHADER, glsl_.uniforms_compute(shader)}});
    default:
      return compiled({{GL_VERTEX_SHADER, tiles}, {GL_FRAGMENT_SHADER, glsl_.deferred_fragment(which)}});
  }
}

}  // namespace kiln
