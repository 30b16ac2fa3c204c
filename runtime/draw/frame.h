// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/gl_objects.h"

namespace kiln {

/// Framebuffer that pictures are drawn into: linear radiance and coverage in float32, depth, and a stencil for deferred
/// shading.
class Frame {
 public:
  Frame(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Binds and clears the framebuffer, and sets the state for drawing assets: depth test, both sides, no blending.
  void begin() const;

  const GlTexture& color() const { return color_; }
  const GlTexture& depth() const { return depth_; }
  const GlFramebuffer& framebuffer() const { return framebuffer_; }

 private:
  int width_, height_;
  GlTexture color_, depth_;
  GlFramebuffer framebuffer_;
};

/// Framebuffer of the first pass of deferred shading: uv and asset number of every sample, and contributions of
/// incident-light samples (16-bit floats) if assets have several. Shares depth and stencil with a Frame of the same
/// size.
class AppearanceFrame {
 public:
  AppearanceFrame(int width, int height, bool with_contributions);

  /// Binds and clears the framebuffer, and the frame's depth and stencil, with the state of Frame::begin.
  void begin(const Frame& frame) const;

  /// Sets the asset number, counted from 1, that the following draws write into the stencil, until begin_shading.
  void begin_asset(int number) const;

  /// Binds the frame, cleared except for its depth, and the textures that AssetRenderer::shade_appearance reads.
  void begin_shading(const Frame& frame) const;

  /// Restricts shading to the samples of one asset: the stencil keeps the shader from running for others.
  void begin_shading_asset(int number) const;

  /// Restores the state of Frame::begin.
  void end_shading(const Frame& frame) const;

 private:
  GlTexture uv_and_asset_, contributions_low_, contributions_high_;
  GlFramebuffer framebuffer_;
};

}  // namespace kiln
