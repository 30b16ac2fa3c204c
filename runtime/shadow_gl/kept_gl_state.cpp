// SPDX-License-Identifier: MIT
#include "runtime/shadow_gl/kept_gl_state.h"

namespace kiln {

KeptGlState::KeptGlState(int map_texels) {
  for (std::size_t k = 0; k < switches.size(); ++k) enabled_[k] = glIsEnabled(switches[k]);
  glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &draw_framebuffer_);
  glGetIntegerv(GL_READ_FRAMEBUFFER_BINDING, &read_framebuffer_);
  glGetIntegerv(GL_CURRENT_PROGRAM, &program_);
  glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &vertex_array_);
  glGetIntegerv(GL_DEPTH_FUNC, &depth_function_);
  glGetIntegerv(GL_CLIP_ORIGIN, &clip_origin_);
  glGetIntegerv(GL_CLIP_DEPTH_MODE, &clip_depth_);
  glGetIntegerv(GL_VIEWPORT, viewport_);
  glGetIntegerv(GL_POLYGON_MODE, polygon_modes_);
  glGetBooleanv(GL_DEPTH_WRITEMASK, &writes_depth_);

  for (const GLenum what : switches) glDisable(what);
  glEnable(GL_CLIP_DISTANCE0);
  glEnable(GL_DEPTH_TEST);
  glEnable(GL_DEPTH_CLAMP);
  glDepthFunc(GL_GREATER);
  glDepthMask(GL_TRUE);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
  glViewport(0, 0, map_texels, map_texels);
}

KeptGlState::~KeptGlState() {
  for (std::size_t k = 0; k < switches.size(); ++k)
    if (enabled_[k] != GL_FALSE)
      glEnable(switches[k]);
    else
      glDisable(switches[k]);
  glDepthFunc(static_cast<GLenum>(depth_function_));
  glDepthMask(writes_depth_);
  glClipControl(static_cast<GLenum>(clip_origin_), static_cast<GLenum>(clip_depth_));
  glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygon_modes_[0]));
  glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
  glBindVertexArray(static_cast<GLuint>(vertex_array_));
  glUseProgram(static_cast<GLuint>(program_));
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_framebuffer_));
  glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_framebuffer_));
}

}  // namespace kiln
