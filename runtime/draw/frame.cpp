// SPDX-License-Identifier: MIT
#include "runtime/draw/frame.h"

#include "gpu/program.h"

namespace kiln {

namespace {

// Texture units of shaders/render_deferred.frag.
constexpr GLuint uv_and_asset_unit = 6, contributions_low_unit = 7, contributions_high_unit = 8;

GlTexture make_target(GLenum format, int width, int height) {
  GlTexture texture = make_texture(GL_TEXTURE_2D);
  glTextureStorage2D(texture.name(), 1, format, width, height);
  return texture;
}

void clear_colors(const GlFramebuffer& framebuffer, int attachments) {
  const GLfloat nothing[4] = {0, 0, 0, 0};
  for (GLint k = 0; k < attachments; ++k) glClearNamedFramebufferfv(framebuffer.name(), GL_COLOR, k, nothing);
}

void clear(const GlFramebuffer& framebuffer, int attachments) {
  clear_colors(framebuffer, attachments);
  glClearNamedFramebufferfi(framebuffer.name(), GL_DEPTH_STENCIL, 0, 1.f, 0);
}

/// Returns an asset's stencil value. Assets beyond the stencil's 255 values share one; the shader tells them apart.
GLint stencil_of(int number) { return (number - 1) % 255 + 1; }

void bind(const GlFramebuffer& framebuffer, int width, int height) {
  glBindFramebuffer(GL_FRAMEBUFFER, framebuffer.name());
  glViewport(0, 0, width, height);
  glEnable(GL_DEPTH_TEST);
  glDepthMask(GL_TRUE);
  glDisable(GL_CULL_FACE);
  glDisable(GL_BLEND);
  glDisable(GL_STENCIL_TEST);
}

}  // namespace

Frame::Frame(int width, int height)
    : width_(width),
      height_(height),
      color_(make_target(GL_RGBA32F, width, height)),
      depth_(make_target(GL_DEPTH32F_STENCIL8, width, height)),
      framebuffer_(make_framebuffer()) {
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, color_.name(), 0);
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_STENCIL_ATTACHMENT, depth_.name(), 0);
  check_gl("making the frame");
}

void Frame::begin() const {
  clear(framebuffer_, 1);
  bind(framebuffer_, width_, height_);
}

AppearanceFrame::AppearanceFrame(int width, int height, bool with_contributions)
    : uv_and_asset_(make_target(GL_RGBA32F, width, height)), framebuffer_(make_framebuffer()) {
  glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT0, uv_and_asset_.name(), 0);
  if (with_contributions) {
    contributions_low_ = make_target(GL_RGBA16F, width, height);
    contributions_high_ = make_target(GL_RGBA16F, width, height);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT1, contributions_low_.name(), 0);
    glNamedFramebufferTexture(framebuffer_.name(), GL_COLOR_ATTACHMENT2, contributions_high_.name(), 0);
  }
  const GLenum attachments[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1, GL_COLOR_ATTACHMENT2};
  glNamedFramebufferDrawBuffers(framebuffer_.name(), with_contributions ? 3 : 1, attachments);
  check_gl("making the frame of appearances");
}

void AppearanceFrame::begin(const Frame& frame) const {
  glNamedFramebufferTexture(framebuffer_.name(), GL_DEPTH_STENCIL_ATTACHMENT, frame.depth().name(), 0);
  clear(framebuffer_, contributions_low_.name() != 0 ? 3 : 1);
  bind(framebuffer_, frame.width(), frame.height());
  glEnable(GL_STENCIL_TEST);
  glStencilMask(0xff);
  glStencilOp(GL_KEEP, GL_KEEP, GL_REPLACE);
}

void AppearanceFrame::begin_asset(int number) const { glStencilFunc(GL_ALWAYS, stencil_of(number), 0xff); }

void AppearanceFrame::begin_shading(const Frame& frame) const {
  clear_colors(frame.framebuffer(), 1);
  glBindFramebuffer(GL_FRAMEBUFFER, frame.framebuffer().name());
  glDisable(GL_DEPTH_TEST);
  glDepthMask(GL_FALSE);
  glStencilOp(GL_KEEP, GL_KEEP, GL_KEEP);
  glBindTextureUnit(uv_and_asset_unit, uv_and_asset_.name());
  glBindTextureUnit(contributions_low_unit, contributions_low_.name());
  glBindTextureUnit(contributions_high_unit, contributions_high_.name());
}

void AppearanceFrame::begin_shading_asset(int number) const { glStencilFunc(GL_EQUAL, stencil_of(number), 0xff); }

void AppearanceFrame::end_shading(const Frame& frame) const {
  bind(frame.framebuffer(), frame.width(), frame.height());
}

}  // namespace kiln
