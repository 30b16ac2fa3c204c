// SPDX-License-Identifier: GPL-3.0-or-later
#include "bake/egl/shadow_maps.h"

#include <algorithm>

#include "bake/egl/views.h"
#include "gpu/program.h"
#include "mesh/same_position.h"
#include "mesh/triangle_edges.h"

namespace kiln {

namespace {

constexpr GLuint no_triangle = ~0u;

GLenum depth_format(ShadowDepth depth) {
  switch (depth) {
    case ShadowDepth::fixed_24:
      return GL_DEPTH_COMPONENT24;
    case ShadowDepth::fixed_16:
      return GL_DEPTH_COMPONENT16;
    case ShadowDepth::float_32:
      break;
  }
  return GL_DEPTH_COMPONENT32F;
}

GlTexture make_map_array(GLenum format, int size, int layers) {
  GlTexture maps = make_texture(GL_TEXTURE_2D_ARRAY);
  glTextureStorage3D(maps.name(), 1, format, size, size, layers);
  for (GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
    glTextureParameteri(maps.name(), filter, GL_NEAREST);
  return maps;
}

GlProgram load_depth_program(bool layered, bool triangle_ids) {
  ShaderDefines defines;
  if (layered) defines.emplace_back("HAS_VERTEX_LAYER", "1");
  if (triangle_ids) return load_program({"bake_depth.vert", "bake_depth.frag"}, defines);
  return load_program({"bake_depth.vert"}, defines);
}

}  // namespace

ShadowMaps::ShadowMaps(const TransferScene& scene, const ShadowMapSettings& settings)
    : settings_(settings),
      size_(settings.size_texels),
      indices_(static_cast<GLsizei>(3 * scene.triangles.size())),
      layered_(settings.layered_pass && epoxy_has_gl_extension("GL_ARB_shader_viewport_layer_array")),
      hull_(scene.hull.begin(), scene.hull.end()),
      positions_(make_buffer(scene.positions)),
      triangles_(make_buffer(scene.triangles)),
      views_(make_refilled_buffer(settings.batch_directions * sizeof(View))),
      occluders_(make_vertex_array()),
      program_(load_depth_program(layered_, settings.triangle_ids)) {
  glVertexArrayVertexBuffer(occluders_.name(), 0, positions_.name(), 0, sizeof(Eigen::Vector3f));
  glVertexArrayAttribFormat(occluders_.name(), 0, 3, GL_FLOAT, GL_FALSE, 0);
  glEnableVertexArrayAttrib(occluders_.name(), 0);
  glVertexArrayElementBuffer(occluders_.name(), triangles_.name());
  const bool back = settings.faces == ShadowFaces::back;
  add_pass(!scene.closed ? GL_NONE : back ? GL_FRONT : GL_BACK, settings.batch_directions);
  if (settings.triangle_ids) {
    corners_ = renumbered(scene.triangles, first_at_position(scene.positions));
    corner_buffer_ = make_buffer(std::span<const std::array<std::uint32_t, 3>>(corners_));
    triangle_maps_ = make_map_array(GL_R32UI, size_, settings.batch_directions);
    const GLuint framebuffer = passes_[0].framebuffer.name();
    if (layered_) glNamedFramebufferTexture(framebuffer, GL_COLOR_ATTACHMENT0, triangle_maps_.name(), 0);
    glNamedFramebufferDrawBuffer(framebuffer, GL_COLOR_ATTACHMENT0);
  }
  if (settings.faces == ShadowFaces::midpoint) add_pass(scene.closed ? GL_FRONT : GL_NONE, settings.batch_directions);
  if (settings.regions) {
    region_maps_ = make_map_array(GL_RG32F, (size_ + region_texels - 1) / region_texels, settings.batch_directions);
    region_program_ = load_program(
        {"bake_regions.comp"},
        {{"CELL", std::to_string(region_texels)}, {"MIDPOINT", settings.faces == ShadowFaces::midpoint ? "1" : "0"}});
  }
}

void ShadowMaps::add_pass(GLenum culled, int layers) {
  Pass& pass = passes_.emplace_back(
      Pass{culled, make_map_array(depth_format(settings_.depth), size_, layers), make_framebuffer()});
  glNamedFramebufferDrawBuffer(pass.framebuffer.name(), GL_NONE);
  if (layered_) glNamedFramebufferTexture(pass.framebuffer.name(), GL_DEPTH_ATTACHMENT, pass.maps.name(), 0);
}

void ShadowMaps::draw(std::span<const Eigen::Vector3f> directions) {
  // Step 1: fit and upload the frames.
  const std::vector<View> views = fit_views(hull_, directions, size_);
  refill_buffer<View>(views_, views);
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, views_.name());

  // Step 2: draw the maps.
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LESS);
  glDepthMask(GL_TRUE);
  glViewport(0, 0, size_, size_);
  glBindVertexArray(occluders_.name());
  glUseProgram(program_.name());
  const int count = static_cast<int>(directions.size());
  for (const Pass& pass : passes_) {
    if (pass.culled == GL_NONE)
      glDisable(GL_CULL_FACE);
    else
      glEnable(GL_CULL_FACE);
    glCullFace(pass.culled == GL_NONE ? GL_BACK : pass.culled);
    const GLuint framebuffer = pass.framebuffer.name();
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    if (layered_) {
      draw_layers(pass, 0, count);
      continue;
    }
    for (int layer = 0; layer < count; ++layer) {
      glNamedFramebufferTextureLayer(framebuffer, GL_DEPTH_ATTACHMENT, pass.maps.name(), 0, layer);
      if (settings_.triangle_ids && &pass == &passes_[0])
        glNamedFramebufferTextureLayer(framebuffer, GL_COLOR_ATTACHMENT0, triangle_maps_.name(), 0, layer);
      draw_layers(pass, layer, 1);
    }
  }
}

void ShadowMaps::draw_layers(const Pass& pass, int first, int count) const {
  const float farthest = 1;
  glClearNamedFramebufferfv(pass.framebuffer.name(), GL_DEPTH, 0, &farthest);
  if (settings_.triangle_ids && &pass == &passes_[0])
    glClearNamedFramebufferuiv(pass.framebuffer.name(), GL_COLOR, 0, &no_triangle);
  glUniform1i(uniform_location(program_, "first_layer"), first);
  // Keep submissions short: drivers reset a device that does not come back for seconds.
  const GLsizei step = 3 * std::max<GLsizei>(1, most_draw_triangles / count);
  for (GLsizei begin = 0; begin < indices_; begin += step) {
    glDrawElementsInstanced(GL_TRIANGLES, std::min(step, indices_ - begin), GL_UNSIGNED_INT,
                            reinterpret_cast<const void*>(static_cast<std::uintptr_t>(begin) * sizeof(std::uint32_t)),
                            count);
    if (begin + step < indices_) glFlush();
  }
}

void ShadowMaps::draw_regions(int directions) const {
  glMemoryBarrier(GL_FRAMEBUFFER_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT);
  glUseProgram(region_program_.name());
  bind();
  glBindImageTexture(0, region_maps_.name(), 0, GL_TRUE, 0, GL_WRITE_ONLY, GL_RG32F);
  const auto cells = static_cast<GLuint>((size_ + region_texels - 1) / region_texels);
  glDispatchCompute((cells + 7) / 8, (cells + 7) / 8, static_cast<GLuint>(directions));
  glMemoryBarrier(GL_TEXTURE_FETCH_BARRIER_BIT);
}

void ShadowMaps::bind() const {
  glBindTextureUnit(0, passes_.front().maps.name());
  glBindTextureUnit(1, passes_.back().maps.name());
  if (settings_.regions) glBindTextureUnit(3, region_maps_.name());
  if (!settings_.triangle_ids) return;
  glBindTextureUnit(2, triangle_maps_.name());
  glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 6, corner_buffer_.name());
}

float ShadowMaps::depth_rounding() const {
  switch (settings_.depth) {
    case ShadowDepth::fixed_24:
      return 0x1p-24f;  // half a step and the rounding of float32
    case ShadowDepth::fixed_16:
      return 0x1p-17f + 0x1p-24f;
    case ShadowDepth::float_32:
      break;
  }
  return 0x1p-24f;
}

}  // namespace kiln
