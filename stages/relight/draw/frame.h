#pragma once

#include "gpu/gl_objects.h"

namespace kiln {

/// Where pictures are drawn: linear radiance and coverage in float32, and depth.
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

/// The first pass of deferred shading: uv and the asset's number of every sample, contributions of incident-light
/// samples (16-bit floats) where assets have several, and depth.
class AppearanceFrame {
 public:
  AppearanceFrame(int width, int height, bool with_contributions);

  /// Binds and clears it, with the state of Frame::begin.
  void begin() const;

  /// Binds its textures for AssetRenderer::shade_appearance, and `into`, cleared, without a depth test.
  void begin_shading(const Frame& into) const;

 private:
  int width_, height_;
  GlTexture uv_and_asset_, contributions_low_, contributions_high_, depth_;
  GlFramebuffer framebuffer_;
};

}  // namespace kiln
