// SPDX-License-Identifier: MIT
#pragma once

#include "gpu/gl_objects.h"

namespace kiln {

/// Where pictures are drawn: linear radiance and coverage in float32, depth, and a stencil for deferred shading.
class Frame {
 public:
  Frame(int width, int height);

  int width() const { return width_; }
  int height() const { return height_; }

  /// Binds and clears it, and sets the state that assets are drawn with: depth test, both sides, no blending.
  void begin() const;

  const GlTexture& colour() const { return colour_; }
  const GlTexture& depth() const { return depth_; }
  const GlFramebuffer& framebuffer() const { return framebuffer_; }

 private:
  int width_, height_;
  GlTexture colour_, depth_;
  GlFramebuffer framebuffer_;
};

/// The first pass of deferred shading of frames of a size: uv and the asset's number of every sample, contributions of
/// incident-light samples (16-bit floats) where assets have several. Depth and stencil are the frame's.
class AppearanceFrame {
 public:
  AppearanceFrame(int width, int height, bool with_contributions);

  /// Binds and clears it, and the frame's depth and stencil, with the state of Frame::begin.
  void begin(const Frame& frame) const;

  /// Of the draws that follow, until begin_shading: the asset's number goes into the stencil. Assets are numbered
  /// from 1.
  void begin_asset(int number) const;

  /// Binds the frame, cleared but for its depth, and the textures that AssetRenderer::shade_appearance reads.
  void begin_shading(const Frame& frame) const;

  /// Only the samples of that asset are shaded: the stencil keeps the shader from running for others.
  void begin_shading_asset(int number) const;

  /// Back to the state of Frame::begin.
  void end_shading(const Frame& frame) const;

 private:
  GlTexture uv_and_asset_, contributions_low_, contributions_high_;
  GlFramebuffer framebuffer_;
};

}  // namespace kiln
