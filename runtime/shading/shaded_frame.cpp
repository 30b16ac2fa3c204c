// SPDX-License-Identifier: MIT
#include "runtime/shading/shaded_frame.h"

#include <vector>

#include "gpu/program.h"

namespace kiln {

namespace {

/// Command of glDrawArraysIndirect, as in shading_tiles.glsl.
struct TileDraw {
  GLuint vertices = 1, tiles = 0, first_vertex = 0, first_instance = 0;
};

GlTexture target(GLenum format, int width, int height, int levels = 1) {
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), levels, format, width, height);
  glTextureParameteri(texture.name(), GL_TEXTURE_MIN_FILTER, levels > 1 ? GL_LINEAR_MIPMAP_LINEAR : GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_MAG_FILTER, levels > 1 ? GL_LINEAR : GL_NEAREST);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
  glTextureParameteri(texture.name(), GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  return texture;
}

GlFramebuffer framebuffer(const GlTexture& color, const GlTexture* depth) {
  GlFramebuffer made = make_framebuffer();
  glNamedFramebufferTexture(made.name(), GL_COLOR_ATTACHMENT0, color.name(), 0);
  if (depth != nullptr) glNamedFramebufferTexture(made.name(), GL_DEPTH_ATTACHMENT, depth->name(), 0);
  return made;
}

constexpr GLfloat nothing[4] = {0, 0, 0, 0}, farthest = 0;  // depths are reversed

}  // namespace

ShadedFrame::ShadedFrame(int width, int height, const Extras& extras, int lists, int levels)
    : width_(width),
      height_(height),
      lists_(lists),
      words_(target(GL_RGBA32UI, width, height)),
      depth_(target(GL_DEPTH_COMPONENT32F, width, height)),
      sampled_(target(GL_RGBA32F, width, height)),
      picture_(target(GL_RGBA32F, width, height, levels)),
      raster_(framebuffer(words_, &depth_)),
      forward_(framebuffer(sampled_, &depth_)),
      picture_frame_(framebuffer(picture_, nullptr)),
      picture_with_depth_(framebuffer(picture_, &depth_)) {
  GLenum written[] = {GL_COLOR_ATTACHMENT0, GL_NONE, GL_NONE};
  const auto add = [&](GLuint place, GLenum format) {
    GlTexture made = target(format, width, height);
    written[place] = GL_COLOR_ATTACHMENT0 + place;
    glNamedFramebufferTexture(raster_.name(), written[place], made.name(), 0);
    return made;
  };
  if (extras.varyings) varyings_ = add(1, GL_RGBA16F);
  if (extras.triangles) triangles_ = add(2, GL_R32UI);
  glNamedFramebufferDrawBuffers(raster_.name(), 3, written);
  const auto tiles = static_cast<GLsizeiptr>(columns()) * rows();
  constexpr auto word = static_cast<GLsizeiptr>(sizeof(GLuint));
  masks_ = make_zero_buffer(tiles * word);
  listed_ = make_zero_buffer(tiles * lists * word);
  const std::vector<TileDraw> none(static_cast<std::size_t>(lists));
  no_commands_ = make_buffer(std::span<const TileDraw>(none));
  commands_ = make_buffer(std::span<const TileDraw>(none));
  check_gl("making the frame of shaded surfaces");
}

void ShadedFrame::clear() const { glClearNamedFramebufferfv(picture_frame_.name(), GL_COLOR, 0, nothing); }

void ShadedFrame::begin_raster() const {
  const GLuint no_words[4] = {0, 0, 0, 0};
  glClearNamedFramebufferuiv(raster_.name(), GL_COLOR, 0, no_words);
  if (varyings_.name() != 0) glClearNamedFramebufferfv(raster_.name(), GL_COLOR, 1, nothing);
  if (triangles_.name() != 0) glClearNamedFramebufferuiv(raster_.name(), GL_COLOR, 2, no_words);
  glClearNamedFramebufferfv(raster_.name(), GL_DEPTH, 0, &farthest);
  glBindFramebuffer(GL_FRAMEBUFFER, raster_.name());
}

void ShadedFrame::begin_forward(bool is_only_sample) const {
  const GlFramebuffer& drawn = is_only_sample ? picture_with_depth_ : forward_;
  glClearNamedFramebufferfv(drawn.name(), GL_COLOR, 0, nothing);
  glClearNamedFramebufferfv(drawn.name(), GL_DEPTH, 0, &farthest);
  glBindFramebuffer(GL_FRAMEBUFFER, drawn.name());
}

void ShadedFrame::begin_picture(bool adds) const {
  glBindFramebuffer(GL_FRAMEBUFFER, picture_frame_.name());
  glDisable(GL_DEPTH_TEST);
  if (adds) {
    glEnable(GL_BLEND);
    glBlendFunc(GL_ONE, GL_ONE);
  }
}

void ShadedFrame::clear_tiles() const {
  glClearNamedBufferData(masks_.name(), GL_R32UI, GL_RED_INTEGER, GL_UNSIGNED_INT, nullptr);
  glCopyNamedBufferSubData(no_commands_.name(), commands_.name(), 0, 0,
                           static_cast<GLsizeiptr>(sizeof(TileDraw)) * lists_);
}

}  // namespace kiln
