// SPDX-License-Identifier: MIT
#pragma once

#include <epoxy/gl.h>

#include <array>

namespace kiln {

/// Sets the GL state that visibility maps are drawn in, and at its end sets all of that back as it was: the
/// framebuffer, viewport, program, vertex array, clip control, how depth is tested and written, and what else would cut
/// or change what is drawn. Bindings of buffers and textures to numbered units are not put back.
class KeptGlState {
 public:
  explicit KeptGlState(int map_texels);
  ~KeptGlState();
  KeptGlState(const KeptGlState&) = delete;
  KeptGlState& operator=(const KeptGlState&) = delete;

 private:
  static constexpr std::array<GLenum, 7> switches = {GL_CLIP_DISTANCE0, GL_DEPTH_TEST,   GL_DEPTH_CLAMP, GL_CULL_FACE,
                                                     GL_BLEND,          GL_STENCIL_TEST, GL_SCISSOR_TEST};
  std::array<GLboolean, switches.size()> enabled_ = {};
  GLint draw_framebuffer_ = 0, read_framebuffer_ = 0, program_ = 0, vertex_array_ = 0, depth_function_ = 0,
        clip_origin_ = 0, clip_depth_ = 0;
  GLint viewport_[4] = {}, polygon_modes_[2] = {};
  GLboolean writes_depth_ = GL_TRUE;
};

}  // namespace kiln
